//! The paper's method against its figures, and its known limits.

#![expect(
    clippy::unwrap_used,
    reason = "a scene that cannot be built or a contact that is missing fails the test there"
)]

mod campaign;
mod elements;
mod limits;
mod rotating;
mod scene;
mod sliding;
mod tracking;
mod walking;
