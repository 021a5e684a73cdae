//! The pair of contact points that places the visual tool, and the paper's three ways to carry it from tick to tick.

use glam::DVec3;
use pliant_collision::cast_ray;
use pliant_mesh::{ConvexMesh, Feature};
use pliant_spatial::Pose;

use super::events::{PaperEvent, PaperEvents};
use super::pairs::{Nearest, PairId, Pairs, Scene};
use super::{INTERSECTION_TOLERANCE, PaperTracker, walk};
use crate::{Contact, Obstacle};

/// Half length of the ray of fig. 4 at least [m]: a tool that slides flat over the old point is hit at a distance of rounding
/// errors, and the step of a creeping hand may be shorter than those.
const SHORTEST_RAY: f64 = 1e-7;

/// Extra distance [m] of the back-off, so that the closest-point query sees a gap. It sets how far the new pair may be off
/// sideways; a thousand times the rounding of the query is enough.
const BACK_OFF_CLEARANCE: f64 = 1e-6;

/// Backing off along the component's normal is refused when that normal makes less than this cosine with the way out: the tool would
/// be carried more than five times as far as it sank in. It then leaves the shortest way.
const LEAST_COSINE: f64 = 0.2;

/// Back-offs per tick. One suffices for one object; between two objects each may push the tool into the other, for which the
/// paper has no rule.
const MAX_BACK_OFFS: u32 = 4;

/// The tracked pair of contact points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Touched object and Contact Element.
    pub(super) pair: PairId,
    /// Touched component of the object.
    pub(super) feature: Feature,
    /// Contact point of the object, object frame [m].
    pub(super) point_in_object: DVec3,
    /// Contact point of the tool, handle frame [m].
    pub(super) point_in_handle: DVec3,
}

/// The part of a motion across a unit normal: `C = M − (M·N) N` (paper, eq. 2). (contact.20)
fn tangential_part(motion: DVec3, normal: DVec3) -> DVec3 {
    motion - motion.dot(normal) * normal
}

impl PaperTracker {
    /// One tick: release, detection, tracking, back-off, in this order.
    pub(super) fn step(
        &mut self,
        scene: Scene<'_>,
        world_from_haptic: &Pose,
        detecting: bool,
        events: &mut PaperEvents,
    ) {
        if let Some(touch) = self.touch
            && detecting
            && !self
                .haptic_pairs
                .any_overlap(scene, touch.pair, world_from_haptic)
        {
            self.touch = None;
            events.push(PaperEvent::Released);
        }
        if let Some(touch) = self.touch {
            self.touch = Some(self.track(scene, touch, world_from_haptic, events));
        } else {
            self.world_from_visual = *world_from_haptic;
            if detecting {
                self.detect(scene, events);
            }
        }
        if let Some(touch) = self.touch
            && detecting
        {
            self.touch = Some(self.back_off(scene, touch, events));
        }
    }

    /// The tracked contact as reported.
    pub(super) fn contact(&self, obstacles: &[Obstacle]) -> Option<Contact> {
        let touch = self.touch?;
        let obstacle = obstacles.get(touch.pair.object as usize)?;
        let offset = self.world_from_visual.translation - self.world_from_haptic.translation;
        Some(Contact {
            object: touch.pair.object,
            segment: touch.pair.segment,
            point: obstacle
                .world_from_object
                .transform_point(touch.point_in_object),
            normal: normal_in_world(obstacle, touch.feature),
            feature: touch.feature,
            share: offset.length(),
        })
    }

    /// First contact (paper §3, fig. 1; §6): the first overlapping segment becomes the Contact Element, and the visual tool is moved by
    /// the difference of the nearest points, so that its contact point lies on the object. (contact.21)
    fn detect(&mut self, scene: Scene<'_>, events: &mut PaperEvents) {
        let pose = self.world_from_visual;
        let first = scene
            .pairs()
            .find_map(|pair| self.haptic_pairs.nearest_below(scene, pair, &pose, 0.0));
        let Some(nearest) = first else { return };
        events.push(PaperEvent::Detected {
            object: nearest.pair.object,
            segment: nearest.pair.segment,
        });
        let support_of = &self.haptic_pairs;
        self.touch = Some(touch_at(
            scene,
            &nearest,
            support_of,
            &pose,
            self.parameters.edge_width,
        ));
        self.world_from_visual.translation -= nearest.separation * nearest.normal;
    }

    /// Tracking (paper §3, eq. 1 and 2, fig. 2): the visual tool moves by the part C of the hand's motion M and takes the
    /// hand's orientation; the contact point goes over to where it now is and is put back on the surface. (contact.20)
    fn track(
        &mut self,
        scene: Scene<'_>,
        mut touch: Touch,
        world_from_haptic: &Pose,
        events: &mut PaperEvents,
    ) -> Touch {
        let obstacle = &scene.obstacles[touch.pair.object as usize];
        let mesh = obstacle.shape.topology();
        let motion = world_from_haptic.translation - self.world_from_haptic.translation;
        let normal = normal_in_world(obstacle, touch.feature);
        let mut visual = Pose::new(
            world_from_haptic.rotation,
            self.world_from_visual.translation + tangential_part(motion, normal),
        );
        let mut point = in_object(obstacle, visual.transform_point(touch.point_in_handle));
        let width = self.parameters.edge_width;
        if walk::adjacent(mesh, touch.feature, point, width).is_some() {
            if let Some(slid) = slide(scene, &touch, point, &visual) {
                events.push(PaperEvent::SlidByRay {
                    from: touch.point_in_handle,
                    to: slid.point_in_handle,
                });
                element_changed(&touch, &slid, events);
                point = in_object(obstacle, visual.transform_point(slid.point_in_handle));
                touch = slid;
            } else {
                touch.feature = walk::walk(mesh, touch.feature, point, width, |from, to| {
                    events.push(PaperEvent::Walked { from, to });
                });
            }
        }
        let normal_in_object = walk::normal(mesh, touch.feature);
        let height = walk::signed_distance(mesh, touch.feature, point);
        visual.translation -= height * normal_in_world(obstacle, touch.feature);
        touch.point_in_object = point - height * normal_in_object;
        self.world_from_visual = visual;
        touch
    }

    /// Back-off (paper §4, fig. 5; §6): while the visual tool intersects, move it off along the normal of the touched component until all its
    /// segments are apart, then set it down on the nearest pair of points; its segment is the Contact Element. (contact.25)
    ///
    /// Every other pair is at least as far away as the nearest one, so with one object setting down intersects nothing.
    fn back_off(&mut self, scene: Scene<'_>, mut touch: Touch, events: &mut PaperEvents) -> Touch {
        for _ in 0..MAX_BACK_OFFS {
            let Some(retreat) = self.retreat(scene, &touch) else {
                break;
            };
            self.world_from_visual.translation += retreat;
            let Some(nearest) = self.nearest_pair(scene, retreat.length()) else {
                break;
            };
            let before = touch;
            let pose = self.world_from_visual;
            let width = self.parameters.edge_width;
            touch = touch_at(scene, &nearest, &self.visual_pairs, &pose, width);
            self.world_from_visual.translation -= nearest.separation * nearest.normal;
            events.push(PaperEvent::BackedOff {
                distance: retreat.length(),
                from: before.point_in_handle,
                to: touch.point_in_handle,
            });
            element_changed(&before, &touch, events);
            if nearest.separation >= 0.0 {
                break;
            }
        }
        touch
    }

    /// Motion [m, world] that takes every intersecting segment off along the touched normal; none if the visual tool is free.
    fn retreat(&mut self, scene: Scene<'_>, touch: &Touch) -> Option<DVec3> {
        let pose = self.world_from_visual;
        let mut deepest: Option<Nearest> = None;
        let mut intersecting = 0;
        for pair in scene.pairs() {
            let limit = -INTERSECTION_TOLERANCE;
            let Some(nearest) = self.visual_pairs.nearest_below(scene, pair, &pose, limit) else {
                continue;
            };
            intersecting += 1;
            if deepest.is_none_or(|d| nearest.separation < d.separation) {
                deepest = Some(nearest);
            }
        }
        let deepest = deepest?;
        let obstacle = &scene.obstacles[touch.pair.object as usize];
        let touched = normal_in_world(obstacle, touch.feature);
        let way_out = if touched.dot(deepest.normal) >= LEAST_COSINE {
            touched
        } else {
            deepest.normal
        };
        // Moving by t along `way_out` separates a pair with normal n once t (n · way_out) reaches its depth.
        let needed = |nearest: &Nearest| {
            let cosine = nearest.normal.dot(way_out);
            let reachable = cosine >= LEAST_COSINE;
            if reachable {
                -nearest.separation / cosine
            } else {
                0.0
            }
        };
        let mut distance = needed(&deepest);
        if intersecting > 1 {
            for pair in scene.pairs() {
                let nearest = self.visual_pairs.nearest_below(scene, pair, &pose, 0.0);
                distance = nearest
                    .as_ref()
                    .map_or(distance, |n| distance.max(needed(n)));
            }
        }
        Some((distance + BACK_OFF_CLEARANCE) * way_out)
    }

    /// The nearest pair of the visual tool. It intersected before it was moved by `moved` [m], so it is no further than that.
    fn nearest_pair(&mut self, scene: Scene<'_>, moved: f64) -> Option<Nearest> {
        let pose = self.world_from_visual;
        let mut best: Option<Nearest> = None;
        for pair in scene.pairs() {
            let limit = best.map_or(moved + INTERSECTION_TOLERANCE, |n| n.separation);
            let nearer = self.visual_pairs.nearest_below(scene, pair, &pose, limit);
            best = nearer.or(best);
        }
        best
    }
}

/// Sliding (paper §4, fig. 4): the contact with the point of the tool that is above the old contact point, if the tool still covers it.
///
/// The ray runs along the normal of the touched component through the old contact point, "towards the Visual Tool": the Contact
/// Element is asked first, then the other segments, of which one that is hit becomes the Contact Element. A hit counts when it is no
/// further from the old point than the contact point of the tool has moved in this tick (`point` in the object frame): one tick's
/// motion cannot open a wider gap under a tool that still lies on the component, and a further hit is another side of the tool. It
/// may be below the old point by as much, where a turned tool dips in. (contact.24)
fn slide(scene: Scene<'_>, touch: &Touch, point: DVec3, world_from_visual: &Pose) -> Option<Touch> {
    let obstacle = &scene.obstacles[touch.pair.object as usize];
    let reach = point.distance(touch.point_in_object).max(SHORTEST_RAY);
    let normal = walk::normal(obstacle.shape.topology(), touch.feature);
    let world_from_object = &obstacle.world_from_object;
    let start = world_from_object.transform_point(touch.point_in_object - reach * normal);
    let along = world_from_object.transform_vector(normal);
    let start = world_from_visual.inverse_transform_point(start);
    let along = world_from_visual.inverse_transform_vector(along);
    // A ray that starts inside a segment has passed its surface: it has no hit near the old point.
    let covered = |segment: &ConvexMesh| {
        let hit = cast_ray(segment, start, along, 2.0 * reach)?;
        (hit.distance > 0.0).then_some(hit.point)
    };
    let with = |segment: u32, point_in_handle: DVec3| Touch {
        pair: PairId {
            segment,
            ..touch.pair
        },
        point_in_handle,
        ..*touch
    };
    let element = touch.pair.segment;
    if let Some(hit) = covered(&scene.segments[element as usize]) {
        return Some(with(element, hit));
    }
    (0..)
        .zip(scene.segments)
        .filter(|(segment, _)| *segment != element)
        .find_map(|(segment, shape)| Some(with(segment, covered(shape)?)))
}

/// The contact of a fresh pair of nearest points, found with the tool at `world_from_handle`.
fn touch_at(
    scene: Scene<'_>,
    nearest: &Nearest,
    pairs: &Pairs,
    world_from_handle: &Pose,
    edge_width: f64,
) -> Touch {
    let obstacle = &scene.obstacles[nearest.pair.object as usize];
    let point_in_object = in_object(obstacle, nearest.on_object);
    let direction = obstacle
        .world_from_object
        .inverse_transform_vector(nearest.normal);
    let feature = walk::locate(
        obstacle.shape.topology(),
        pairs.support_vertex(nearest.pair, obstacle),
        (point_in_object, direction),
        edge_width,
    );
    Touch {
        pair: nearest.pair,
        feature,
        point_in_object,
        point_in_handle: world_from_handle.inverse_transform_point(nearest.on_tool),
    }
}

/// Another segment in contact is the Contact Element from now on (paper §6). (contact.26)
fn element_changed(before: &Touch, now: &Touch, events: &mut PaperEvents) {
    if before.pair.segment != now.pair.segment {
        events.push(PaperEvent::ElementChanged {
            from: before.pair.segment,
            to: now.pair.segment,
        });
    }
}

fn normal_in_world(obstacle: &Obstacle, feature: Feature) -> DVec3 {
    let normal = walk::normal(obstacle.shape.topology(), feature);
    obstacle.world_from_object.transform_vector(normal)
}

fn in_object(obstacle: &Obstacle, point_in_world: DVec3) -> DVec3 {
    obstacle
        .world_from_object
        .inverse_transform_point(point_in_world)
}
