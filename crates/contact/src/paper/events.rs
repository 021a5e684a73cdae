//! What a tick of the paper's method did, for drawing and for tests.

use glam::DVec3;
use pliant_mesh::Feature;
use pliant_spatial::Pose;

use crate::Contact;

/// Events kept per tick. A walk of a hand at 1 m/s over 1 mm facets takes a handful; later ones are counted, not kept.
const CAPACITY: usize = 16;

/// One thing that happened in a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PaperEvent {
    /// The haptic tool was found in an object and the visual tool placed on its surface (§3, fig. 1).
    Detected {
        /// Index of the obstacle.
        object: u32,
        /// Index of the tool segment: the Contact Element.
        segment: u32,
    },
    /// The contact point went over to an adjacent component (§3, fig. 3).
    Walked {
        /// Component left.
        from: Feature,
        /// Component reached.
        to: Feature,
    },
    /// The contact point of the tool left the component and was replaced by a ray cast (§4, fig. 4).
    SlidByRay {
        /// Contact point of the tool before, handle frame [m].
        from: DVec3,
        /// Contact point of the tool now, handle frame [m].
        to: DVec3,
    },
    /// The visual tool intersected, was moved off and set down on a new pair of points (§4, fig. 5).
    BackedOff {
        /// How far it was moved off [m].
        distance: f64,
        /// Contact point of the tool before, handle frame [m].
        from: DVec3,
        /// Contact point of the tool now, handle frame [m].
        to: DVec3,
    },
    /// Another segment became the Contact Element (§6).
    ElementChanged {
        /// Segment before.
        from: u32,
        /// Segment now.
        to: u32,
    },
    /// The haptic tool left the object; the visual tool is back on it (§3).
    Released,
}

/// The events of one tick in order, in fixed memory.
#[derive(Clone, Copy, Debug)]
pub struct PaperEvents {
    items: [PaperEvent; CAPACITY],
    kept: usize,
    dropped: u32,
}

impl Default for PaperEvents {
    fn default() -> Self {
        Self {
            items: [PaperEvent::Released; CAPACITY],
            kept: 0,
            dropped: 0,
        }
    }
}

impl PaperEvents {
    /// The first events of the tick, in order.
    pub fn as_slice(&self) -> &[PaperEvent] {
        &self.items[..self.kept]
    }

    /// Events for which there was no room.
    pub fn dropped(&self) -> u32 {
        self.dropped
    }

    pub(super) fn push(&mut self, event: PaperEvent) {
        if let Some(slot) = self.items.get_mut(self.kept) {
            *slot = event;
            self.kept += 1;
        } else {
            self.dropped += 1;
        }
    }
}

/// Result of one tick.
#[derive(Clone, Copy, Debug)]
pub struct PaperOutcome {
    /// Handle pose of the visual tool; its orientation is the haptic tool's.
    pub world_from_visual: Pose,
    /// The tracked contact; its normal is that of the touched component.
    pub contact: Option<Contact>,
    /// Contact point of the tool, handle frame [m]: at the visual pose the point on the object, at the haptic pose the other end of
    /// the paper's spring.
    pub tool_point: Option<DVec3>,
    /// What happened.
    pub events: PaperEvents,
}

#[cfg(test)]
mod tests {
    use super::{CAPACITY, PaperEvent, PaperEvents};

    #[test]
    fn events_beyond_the_capacity_are_counted() {
        let mut events = PaperEvents::default();
        assert!(events.as_slice().is_empty());
        for to in 0..20 {
            events.push(PaperEvent::ElementChanged { from: 0, to });
        }
        assert_eq!(events.as_slice().len(), CAPACITY);
        assert_eq!(events.dropped(), 4);
        let last = PaperEvent::ElementChanged { from: 0, to: 15 };
        assert_eq!(events.as_slice().last(), Some(&last));
    }
}
