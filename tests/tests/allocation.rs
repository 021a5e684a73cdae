//! A tick allocates nothing: a counting allocator watches the ticks of both methods, device and servo included.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use pliant_contact::PaperParameters;
use pliant_device::{ScriptedDevice, TimedPose, Trajectory, WorkspaceMap};
use pliant_servo::{Rate, Servo, ServoParts};
use pliant_sim::Method;
use pliant_tests::bodies::{Setting, ToolKind, world};
use pliant_tests::hand::RandomHand;

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
        count();
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

/// A hand's path over the object, 5 s.
fn trajectory() -> Trajectory {
    let mut hand = RandomHand::new(5, glam::DVec3::splat(0.045));
    let samples: Vec<TimedPose> = (0..5000)
        .map(|index| TimedPose {
            time: f64::from(index) * 1e-3,
            pose: hand.advance(glam::DVec3::ZERO, 1e-3),
        })
        .collect();
    Trajectory::new(&samples).expect("a smooth path")
}

fn allocations_of_ticks(setting: Setting, segments: u32, method: Method) -> (u64, u32) {
    let mut servo = Servo::new(ServoParts {
        world: world(setting, ToolKind::Rod.tool(segments), method),
        device: Box::new(ScriptedDevice::new("path", trajectory())),
        map: WorkspaceMap::IDENTITY,
        rate: Rate::DEFAULT,
    })
    .expect("valid");
    let before = allocations();
    let mut contact_ticks = 0;
    for _ in 0..5000 {
        let sample = servo.step().expect("a scripted device does not fail");
        contact_ticks += u32::from(sample.output.contacts > 0);
    }
    (allocations() - before, contact_ticks)
}

#[test]
fn no_tick_of_either_method_allocates() {
    let paper = Method::Paper(PaperParameters::default());
    for setting in [
        Setting::Box,
        Setting::LatitudeLongitude,
        Setting::Corner,
        Setting::Slot,
    ] {
        for segments in [1, 10] {
            for method in [Method::Constrained, paper] {
                let (count, contact_ticks) = allocations_of_ticks(setting, segments, method);
                assert!(
                    contact_ticks > 500,
                    "{setting:?} {method:?}: {contact_ticks} contact ticks"
                );
                assert_eq!(count, 0, "{setting:?}, {segments} segments, {method:?}");
            }
        }
    }
}

#[test]
fn the_counter_counts() {
    let before = allocations();
    std::hint::black_box(Box::new(1));
    assert!(allocations() > before);
}
