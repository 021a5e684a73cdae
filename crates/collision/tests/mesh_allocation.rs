//! Mesh queries allocate nothing once their buffers have grown: a counting allocator watches.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use glam::{DQuat, DVec3};
use pliant_collision::{
    Cuboid, MeshCache, ObjectBvh, PointSet, Rounded, Segment, SupportMap, TriangleBvh,
};
use pliant_mesh::generate::latitude_longitude_ellipsoid;
use pliant_mesh::{Aabb, ConvexMesh, TriangleMesh};
use pliant_spatial::Pose;

struct Counting;

thread_local! {
    static ALLOCATIONS: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // A thread that is shutting down has no counter any more, and nothing here looks at it.
    let _ = ALLOCATIONS.try_with(|n| n.set(n.get() + 1));
}

#[expect(unsafe_code, reason = "the global allocator's interface is unsafe")]
// SAFETY: every call is handed to the system allocator unchanged; counting touches a thread-local integer only.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is passed on.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: the caller's promise is passed on.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: the caller's promise is passed on.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

fn allocations() -> u64 {
    ALLOCATIONS.with(Cell::get)
}

fn mesh() -> TriangleMesh {
    latitude_longitude_ellipsoid(DVec3::new(0.1, 0.08, 0.06), 96, 67).expect("valid")
}

/// Around the mesh, in and out of it.
fn pose(step: u32) -> Pose {
    let angle = 0.01 * f64::from(step);
    let height = 1.0 + 0.2 * (0.37 * angle).sin();
    let at = DVec3::new(0.1 * angle.cos(), 0.08 * angle.sin(), 0.03) * height;
    Pose::new(
        DQuat::from_scaled_axis(DVec3::new(angle, 0.3, -0.5 * angle)),
        at,
    )
}

fn run(
    bvh: &TriangleBvh,
    mesh: &TriangleMesh,
    shape: &dyn SupportMap,
    cache: &mut MeshCache,
) -> usize {
    let mut contacts = 0;
    for step in 0..700 {
        let pose = pose(step);
        contacts += bvh.contacts(mesh, shape, &pose, 0.001, cache).len();
        contacts += bvh.every_contact(mesh, shape, &pose, 0.0, cache).len();
        contacts += usize::from(bvh.deepest(mesh, shape, &pose, 0.1, cache).is_some());
        let hit = bvh.cast_shape(mesh, shape, &pose, DVec3::Z * -0.02);
        contacts += usize::from(hit.is_some());
    }
    contacts
}

#[test]
fn shape_queries_allocate_nothing_after_warm_up() {
    let mesh = mesh();
    let bvh = TriangleBvh::new(&mesh);
    let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|v| {
        Cuboid {
            half: DVec3::new(0.04, 0.01, 0.01),
        }
        .vertex(v)
    });
    let segment = Segment {
        a: DVec3::ZERO,
        b: DVec3::X * 0.08,
    };
    let capsule = Rounded {
        core: segment,
        radius: 0.003,
    };
    let hull = ConvexMesh::hull(&corners).expect("valid");
    let shapes: [&dyn SupportMap; 4] = [&PointSet(&corners), &capsule, &hull, &segment];
    for shape in shapes {
        let mut cache = MeshCache::default();
        let contacts = run(&bvh, &mesh, shape, &mut cache);
        assert!(contacts > 1500, "{contacts}");
        cache.clear();
        let before = allocations();
        run(&bvh, &mesh, shape, &mut cache);
        assert_eq!(allocations() - before, 0);
    }
}

#[test]
fn trees_allocate_only_when_built() {
    let mesh = mesh();
    let mut bvh = TriangleBvh::new(&mesh);
    let boxes: Vec<Aabb> = (0..500)
        .map(|i| Aabb::from_points(&[DVec3::splat(f64::from(i)), DVec3::splat(f64::from(i) + 1.5)]))
        .collect();
    let mut objects = ObjectBvh::new(&boxes);
    let before = allocations();
    bvh.refit(&mesh);
    objects.refit(&boxes);
    let mut found = 0;
    bvh.overlapping(&mesh.bounds(), |_| found += 1);
    objects.pairs(&boxes, |_, _| found += 1);
    objects.along_ray(DVec3::ZERO, DVec3::ONE.normalize(), 1e3, |_, reach| reach);
    let hit = bvh.cast_ray(&mesh, DVec3::ZERO, DVec3::X, 1.0);
    let near = bvh.closest_point(&mesh, DVec3::ONE, 10.0);
    assert_eq!(allocations() - before, 0);
    assert!(found > 12_672 && hit.is_some() && near.is_some());
}

#[test]
fn the_counter_counts() {
    let before = allocations();
    std::hint::black_box(Box::new(1));
    assert!(allocations() > before);
}
