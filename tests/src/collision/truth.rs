//! The two oracles behind one face: enumeration for polytopes, search for cylinders and cones.

use glam::DVec3;
use pliant_spatial::Pose;

use super::oracle::Scene;
use super::search::Search;
use super::shape::Shape;

/// Who knows the truth about two cores at a placement.
pub enum Oracle<'p> {
    /// Enumeration of the features of two polytopes.
    Features(Scene<'p>),
    /// Search over directions: at least one is a cylinder or cone.
    Directions(Search<'p>),
}

impl<'p> Oracle<'p> {
    /// The one in charge.
    pub fn new(a: &'p Shape, b: &'p Shape, a_from_b: &Pose) -> Self {
        if a.body.turned().is_some() || b.body.turned().is_some() {
            Self::Directions(Search::new(a, b, a_from_b))
        } else {
            Self::Features(Scene::new(&a.core, &b.core, a_from_b))
        }
    }

    /// Signed distance of the cores [m] and its direction, in A's frame from A to B.
    pub fn signed_distance(&self) -> (f64, DVec3) {
        match self {
            Self::Features(scene) => {
                let truth = scene.truth();
                (truth.separation, truth.normal)
            }
            Self::Directions(search) => search.best(),
        }
    }

    /// Signed distance and how far it may be off [m]. A search also climbs from a direction proposed by the crate under
    /// test: its gap is a lower bound of the truth whoever proposes it.
    pub fn truth(&self, proposed: impl FnOnce() -> DVec3) -> (f64, f64) {
        match self {
            Self::Features(scene) => {
                let truth = scene.truth();
                (truth.separation, truth.doubt)
            }
            Self::Directions(search) => {
                let own = search.best().0;
                let other = proposed().try_normalize();
                let other = other.map_or(own, |normal| search.climb(normal, 1e-3).0);
                (own.max(other), 0.0)
            }
        }
    }

    /// Gap between the supporting planes of the cores across a unit direction in A's frame, from A to B [m].
    pub fn gap(&self, normal: DVec3) -> f64 {
        match self {
            Self::Features(scene) => scene.gap(normal),
            Self::Directions(search) => search.gap(normal),
        }
    }

    /// Largest coordinate of the difference [m]: what rounding is relative to.
    pub fn span(&self) -> f64 {
        match self {
            Self::Features(scene) => scene.span(),
            Self::Directions(search) => search.span(),
        }
    }

    /// Of two points in A's frame from the cores of A and B [m].
    pub fn distances(&self, on_a: DVec3, on_b: DVec3) -> [f64; 2] {
        match self {
            Self::Features(scene) => scene.distances(on_a, scene.in_b(on_b)),
            Self::Directions(search) => search.distances(on_a, search.in_b(on_b)),
        }
    }
}
