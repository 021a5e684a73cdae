//! The contact method of S. D. Laycock and A. M. Day, "The Haptic Rendering of Polygonal Models involving Deformable Tools"
//! (2003), sections 3, 4 and 6, kept as the paper has it so that it can be compared with [`crate::ConstrainedTracker`].
//!
//! One pair of contact points, one on an object and one on the tool, places the visual tool. Each tick:
//!
//! 1. *Release* (§3): tracking ends when the haptic tool no longer overlaps the touched object.
//! 2. *Detection* (§3, fig. 1): a free tool whose haptic pose overlaps an object is placed on its surface by the nearest points;
//!    the first overlapping segment is the *Contact Element* (§6).
//! 3. *Tracking* (§3, eq. 1 and 2, fig. 2): the visual tool moves by the part of the hand's motion across the normal of the
//!    touched component and takes the hand's orientation.
//! 4. *Walk* (§3, fig. 3) over faces, edges and vertices to the component under the contact point, or *slide* (§4, fig. 4): a ray
//!    from the old contact point finds the part of the tool that is above it now. The contact point is then put on the surface.
//! 5. *Back-off* (§4, fig. 5; §6): a visual tool that intersects is moved off along the normal and returned to the nearest pair of
//!    points, whose segment becomes the Contact Element.
//!
//! The deformable part (§5) is not here. What the paper leaves open, what is chosen and what the method gets wrong, with
//! figures, is told in `docs/paper.md`. Where it departs: several objects count as one scene, so back-off looks at all of them.

mod events;
mod pairs;
mod touch;
mod walk;

use pliant_mesh::ConvexMesh;
use pliant_spatial::Pose;

pub use events::{PaperEvent, PaperEvents, PaperOutcome};
use pairs::Pairs;
use touch::Touch;

use crate::Obstacle;

/// Overlap [m] of the visual tool that is left alone: a contact at rest is at ±1e-17 m, rounding of a metre-sized scene at 1e-15;
/// a larger value lets the tool sink in by as much, a smaller one backs off for noise.
const INTERSECTION_TOLERANCE: f64 = 1e-9;

/// Settings of the paper's method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaperParameters {
    /// Width of the thin flat rectangles that stand for edges (§3) [m]: a contact point on an edge stays on it until it is half
    /// this far to a side. Larger: calmer on edges, and the tool floats up to half the width above sharp ones.
    pub edge_width: f64,
    /// Collision detection runs every so many ticks (§6: 2 "for larger meshes"); 0 counts as 1. Tracking runs every tick.
    pub detection_interval: u32,
}

impl Default for PaperParameters {
    fn default() -> Self {
        Self {
            edge_width: 1e-4,
            detection_interval: 1,
        }
    }
}

/// State of the paper's method: both tools, the contact pair, warm starts. Allocates only in [`PaperTracker::new`].
#[derive(Clone, Debug)]
pub struct PaperTracker {
    parameters: PaperParameters,
    ticks: u64,
    world_from_haptic: Pose,
    world_from_visual: Pose,
    touch: Option<Touch>,
    haptic_pairs: Pairs,
    visual_pairs: Pairs,
}

impl PaperTracker {
    /// Both tools at `world_from_haptic` (handle pose), nothing touched: contact is looked for on the first tick.
    ///
    /// `segments` are the convex elements of the tool in the handle frame (origin at the clamp, +x to the tip) [m].
    pub fn new(
        obstacles: &[Obstacle],
        segments: &[ConvexMesh],
        parameters: &PaperParameters,
        world_from_haptic: Pose,
    ) -> Self {
        let pairs = Pairs::new(obstacles.len(), segments.len());
        Self {
            parameters: *parameters,
            ticks: 0,
            world_from_haptic,
            world_from_visual: world_from_haptic,
            touch: None,
            haptic_pairs: pairs.clone(),
            visual_pairs: pairs,
        }
    }

    /// One tick with the haptic tool at `world_from_haptic` (handle pose). Allocates nothing.
    ///
    /// `obstacles` and `segments` are those of [`PaperTracker::new`]; entries beyond their number then are not seen, and contact with
    /// a missing one ends. A pose that is not finite changes nothing.
    pub fn advance(
        &mut self,
        obstacles: &[Obstacle],
        segments: &[ConvexMesh],
        world_from_haptic: &Pose,
    ) -> PaperOutcome {
        let scene = self.visual_pairs.known(obstacles, segments);
        self.touch = self.touch.filter(|touch| touch.pair.is_in(scene));
        let mut events = PaperEvents::default();
        if world_from_haptic.is_finite() {
            let detecting = self
                .ticks
                .is_multiple_of(u64::from(self.parameters.detection_interval.max(1)));
            self.ticks = self.ticks.wrapping_add(1);
            self.step(scene, world_from_haptic, detecting, &mut events);
            self.world_from_haptic = *world_from_haptic;
        }
        PaperOutcome {
            world_from_visual: self.world_from_visual,
            contact: self.contact(obstacles),
            tool_point: self.touch.map(|touch| touch.point_in_handle),
            events,
        }
    }

    /// Handle pose of the visual tool.
    pub fn world_from_visual(&self) -> Pose {
        self.world_from_visual
    }

    /// Handle pose of the haptic tool at the last tick.
    pub fn world_from_haptic(&self) -> Pose {
        self.world_from_haptic
    }
}
