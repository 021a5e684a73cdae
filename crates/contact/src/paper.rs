//! The contact method of Laycock & Day (2003), sections 3 and 4.
