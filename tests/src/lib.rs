//! Campaigns, judges and scenes shared by the tests that span crates.
