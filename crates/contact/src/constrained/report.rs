//! What the pressing planes mean to the hand: contact points, features, shares of the force, moment about the handle.

use glam::{DVec2, DVec3};
use pliant_mesh::Feature;

use super::MAX_CONTACTS;
use super::cell::{Bodies, Cell, segment_bound};
use super::feature::feature_under;
use super::patch::PatchPlane;
use super::shading::Shading;
use super::slab::{SLAB, SlabWalk};
use crate::Contact;
use crate::qp::ActiveSet;
use crate::share::regularised_shares;

/// Report of one tick.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Report {
    pub(crate) contacts: [Option<Contact>; MAX_CONTACTS],
    pub(crate) push: DVec3,
    pub(crate) moment: DVec3,
}

/// Where the coupling starts and where it pulls to [m]; the same point unless the coupling is damped.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pull {
    pub(crate) haptic: DVec3,
    pub(crate) target: DVec3,
}

/// Labels kept from tick to tick, and scratch.
#[derive(Clone, Debug)]
pub(crate) struct Reporter {
    /// Contact Element of each obstacle.
    elements: Vec<Option<u32>>,
    /// Feature touched last, of each obstacle.
    features: Vec<Option<Feature>>,
    shading: Vec<Option<Shading>>,
    walk: SlabWalk,
    plane: PatchPlane,
}

impl Reporter {
    pub(crate) fn new(bodies: Bodies<'_>) -> Self {
        let obstacle_points = bodies
            .obstacles
            .iter()
            .map(|o| o.shape.positions().len())
            .max()
            .unwrap_or(0);
        let segment_points = bodies.segments.iter().map(|s| s.positions().len());
        let largest = segment_points.max().unwrap_or(0);
        Self {
            elements: vec![None; bodies.obstacles.len()],
            features: vec![None; bodies.obstacles.len()],
            shading: bodies.obstacles.iter().map(Shading::new).collect(),
            walk: SlabWalk::new(obstacle_points.max(largest)),
            plane: PatchPlane::new(SlabWalk::MOST, SlabWalk::MOST * bodies.segments.len()),
        }
    }

    /// Contacts of the pressing planes and the load they put on the haptic handle.
    pub(crate) fn report(
        &mut self,
        cell: &mut Cell,
        bodies: Bodies<'_>,
        active: &ActiveSet,
        pull: &Pull,
    ) -> Report {
        let visual = cell.pose.translation;
        // The reaction of all contacts together points from the target to the visual tool. Undamped, the spring does too; a damper that
        // trails a turning normal could make it pull, and contact never pulls.
        let reaction = (visual - pull.target).normalize_or_zero();
        let spring = visual - pull.haptic;
        let push = spring - reaction * spring.dot(reaction).min(0.0);
        let mut contacts = [None; MAX_CONTACTS];
        let mut normals = [DVec3::ZERO; MAX_CONTACTS];
        let mut count = 0;
        for (pair, _) in active.iter() {
            let contact = self.contact(cell, bodies, pair);
            normals[count] = contact.normal;
            contacts[count] = Some(contact);
            count += 1;
        }
        let shares = regularised_shares(&normals[..count], push);
        for (contact, share) in contacts.iter_mut().flatten().zip(shares) {
            contact.share = share;
        }
        let rendered = self.shaded(bodies, &contacts, push);
        let moment = moment(&contacts, rendered, pull.haptic);
        contacts[..count].sort_unstable_by(|a, b| {
            let share = |c: &Option<Contact>| c.map_or(0.0, |c| c.share);
            share(b).total_cmp(&share(a))
        });
        self.forget_released(&contacts);
        Report {
            contacts,
            push: rendered,
            moment,
        }
    }

    fn forget_released(&mut self, contacts: &[Option<Contact>; MAX_CONTACTS]) {
        for (object, element) in self.elements.iter_mut().enumerate() {
            if !contacts
                .iter()
                .flatten()
                .any(|c| c.object as usize == object)
            {
                *element = None;
            }
        }
    }

    /// Patch centroid, Contact Element and feature of one pressing pair.
    fn contact(&mut self, cell: &mut Cell, bodies: Bodies<'_>, pair: usize) -> Contact {
        let entry = cell.pairs[pair];
        let object = cell.obstacle_of(pair);
        let obstacle = &bodies.obstacles[object];
        let normal = entry.normal;
        let top = obstacle.shape.positions()[entry.obstacle_vertex as usize];
        let origin = obstacle.world_from_object.transform_point(top);
        let (u, v) = normal.any_orthonormal_pair();
        let flat = |p: DVec3| DVec2::new(u.dot(p - origin), v.dot(p - origin));

        let element = self.gather_tool(cell, bodies, pair, flat);
        let local_normal = obstacle.world_from_object.inverse_transform_vector(normal);
        let shape = &obstacle.shape;
        let support = self.walk.visit(shape, local_normal, entry.obstacle_vertex);
        let outline = &mut self.plane.obstacle;
        outline.clear();
        outline.extend(support.vertices.iter().map(|&vertex| {
            let p = shape.positions()[vertex as usize];
            flat(obstacle.world_from_object.transform_point(p))
        }));
        let centre = self.plane.centroid().unwrap_or_else(|| flat(entry.witness));
        let point = origin + u * centre.x + v * centre.y;
        let local = obstacle.world_from_object.inverse_transform_point(point);
        let last = self.features[object];
        let feature = feature_under(shape.topology(), &support, (local_normal, local), last);
        self.features[object] = Some(feature);
        Contact {
            object: index_u32(object),
            segment: element,
            point,
            normal,
            feature,
            share: 0.0,
        }
    }

    /// Support polygon of all segments that touch along this plane, and the Contact Element: last tick's as long as it touches.
    fn gather_tool(
        &mut self,
        cell: &mut Cell,
        bodies: Bodies<'_>,
        pair: usize,
        flat: impl Fn(DVec3) -> DVec2,
    ) -> u32 {
        let object = cell.obstacle_of(pair);
        let entry = cell.pairs[pair];
        let pose = cell.pose;
        let reach = cell.gap(pair) + SLAB;
        let kept = self.elements[object];
        let mut element = index_u32(cell.segment_of(pair));
        self.plane.tool.clear();
        for other in cell.group(object) {
            let segment = &bodies.segments[cell.segment_of(other)];
            let start = cell.pairs[other].segment_vertex;
            let (bound, vertex) = segment_bound(segment, pose.rotation, entry.normal, start);
            if entry.normal.dot(pose.translation) + bound - entry.obstacle_bound > reach {
                continue;
            }
            if kept == Some(index_u32(cell.segment_of(other))) {
                element = index_u32(cell.segment_of(other));
            }
            let outline = &mut self.plane.tool;
            let down = -pose.inverse_transform_vector(entry.normal);
            let support = self.walk.visit(segment, down, vertex);
            outline.extend(support.vertices.iter().map(|&vertex| {
                let p = segment.positions()[vertex as usize];
                flat(pose.transform_point(p))
            }));
        }
        self.elements[object] = Some(element);
        element
    }

    /// `push` with its direction taken from interpolated normals where obstacles are shaded; its length is kept.
    fn shaded(
        &self,
        bodies: Bodies<'_>,
        contacts: &[Option<Contact>; MAX_CONTACTS],
        push: DVec3,
    ) -> DVec3 {
        let mut turned = push;
        for contact in contacts.iter().flatten() {
            let object = contact.object as usize;
            let Some(shading) = &self.shading[object] else {
                continue;
            };
            let obstacle = &bodies.obstacles[object];
            let pose = &obstacle.world_from_object;
            let normal = shading.normal(
                obstacle.shape.topology(),
                contact.feature,
                pose.inverse_transform_point(contact.point),
                pose.inverse_transform_vector(contact.normal),
            );
            turned += contact.share * (pose.transform_vector(normal) - contact.normal);
        }
        turned
            .try_normalize()
            .map_or(push, |direction| direction * push.length())
    }
}

/// Moment of `push` about `haptic` [m²] (contact.8): each contact carries its share at its patch, the remainder acts at the
/// shares' centre.
fn moment(contacts: &[Option<Contact>; MAX_CONTACTS], push: DVec3, haptic: DVec3) -> DVec3 {
    let mut moment = DVec3::ZERO;
    let mut carried = DVec3::ZERO;
    let mut centre = DVec3::ZERO;
    let mut total = 0.0;
    for contact in contacts.iter().flatten() {
        let part = contact.normal * contact.share;
        moment += (contact.point - haptic).cross(part);
        carried += part;
        centre += contact.point * contact.share;
        total += contact.share;
    }
    if total > 0.0 {
        moment += (centre / total - haptic).cross(push - carried);
    }
    moment
}

fn index_u32(index: usize) -> u32 {
    u32::try_from(index).expect("objects and segments are counted in u32")
}
