//! Where the tip of the tool goes in each shipped scene.

use glam::DVec3;

/// A moment of a path.
pub(crate) struct Keyframe {
    /// [s].
    pub(crate) time: f64,
    /// Middle of the tool's end, world [m].
    pub(crate) tip: DVec3,
    /// From the clamp to the tip, world, any length.
    pub(crate) direction: DVec3,
    /// About the tool's own axis [degrees].
    pub(crate) roll: f64,
}

impl Keyframe {
    /// The keyframe's time in whole ticks of 1 ms.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a few seconds"
    )]
    pub(crate) fn millisecond(&self) -> u32 {
        (self.time * 1000.0).round() as u32
    }
}

/// Time [s], tip [mm], direction, roll [degrees].
type Row = (f64, [f64; 3], [f64; 3], f64);

/// The path of a shipped scene.
pub(crate) fn path_of(scene: &str) -> Option<Vec<Keyframe>> {
    Some(match scene {
        "probe_on_box" => keyframes(&BOX),
        "probe_on_ellipsoid" => around_the_ellipsoid(),
        "probe_through_plate" => keyframes(&PLATE),
        "two_objects" => keyframes(&CORNER),
        "slot" => keyframes(&SLOT),
        "any_mesh" => keyframes(&STAR),
        _ => return None,
    })
}

fn keyframes(rows: &[Row]) -> Vec<Keyframe> {
    rows.iter()
        .map(|&(time, tip, direction, roll)| Keyframe {
            time,
            tip: DVec3::from(tip) * 1e-3,
            direction: DVec3::from(direction),
            roll,
        })
        .collect()
}

/// Down on the top, across it, over an edge with the shaft, back, turning in place, over a corner and away.
const BOX: [Row; 16] = [
    (0.0, [-30.0, -25.0, 18.0], [0.8, 0.0, -1.0], 0.0),
    (0.5, [-30.0, -25.0, 0.0], [0.8, 0.0, -1.0], 0.0),
    (1.2, [-5.0, 15.0, -2.0], [0.8, 0.2, -1.0], 20.0),
    (1.9, [30.0, 20.0, -2.0], [0.8, -0.2, -1.0], 45.0),
    (2.5, [50.0, 5.0, -2.0], [0.9, 0.0, -1.0], 45.0),
    (3.0, [58.0, -5.0, -14.0], [0.9, 0.1, -1.0], 20.0),
    (3.6, [58.0, -20.0, -18.0], [0.8, 0.4, -1.0], 0.0),
    (4.2, [46.0, -15.0, -3.0], [0.6, 0.0, -1.0], 0.0),
    (4.8, [25.0, 0.0, -2.0], [0.4, 0.5, -1.0], 60.0),
    (5.4, [25.0, 0.0, -2.0], [-0.5, 0.5, -1.0], 120.0),
    (6.0, [25.0, 10.0, -2.0], [-0.5, -0.5, -1.0], 160.0),
    (6.6, [40.0, 38.0, -2.0], [0.0, -0.8, -1.0], 180.0),
    (7.2, [52.0, 52.0, -3.0], [-0.3, -0.5, -1.0], 180.0),
    (7.7, [56.0, 52.0, -22.0], [-0.6, -0.3, -0.8], 200.0),
    (8.2, [50.0, 20.0, -25.0], [-1.0, 0.0, -0.5], 220.0),
    (8.8, [80.0, 20.0, -10.0], [-1.0, 0.0, -0.6], 220.0),
];

/// Flat on the thin plate, deeper than plate and tool are thick; then slide over it, over its rim and against it from
/// below.
const PLATE: [Row; 14] = [
    (0.0, [30.0, 0.0, 15.0], [1.0, 0.0, 0.0], 0.0),
    (0.6, [30.0, 0.0, 1.0], [1.0, 0.0, 0.0], 0.0),
    (1.2, [30.0, 0.0, -5.0], [1.0, 0.0, 0.0], 0.0),
    (1.9, [25.0, 10.0, -5.0], [1.0, 0.1, 0.0], 10.0),
    (2.6, [10.0, 12.0, -2.0], [0.6, 0.2, -0.8], 30.0),
    (3.3, [20.0, -10.0, -4.0], [-0.4, 0.3, -1.0], 60.0),
    (4.0, [30.0, -10.0, -4.0], [-1.0, 0.0, -0.6], 90.0),
    (4.6, [47.0, 0.0, -4.0], [-1.0, 0.0, -0.8], 90.0),
    (5.2, [53.0, 5.0, -6.0], [-1.0, 0.0, -0.6], 90.0),
    (5.8, [58.0, 8.0, -14.0], [-1.0, 0.0, -0.3], 90.0),
    (6.5, [30.0, 8.0, -10.0], [-1.0, 0.0, 0.3], 90.0),
    (7.2, [25.0, 0.0, 4.0], [-1.0, 0.0, 0.5], 120.0),
    (7.9, [30.0, -25.0, 4.0], [-1.0, -0.2, 0.6], 150.0),
    (8.6, [70.0, -25.0, -25.0], [-1.0, 0.0, 0.6], 150.0),
];

/// Along the floor into the wall, along the corner, turning in it, up the wall and off.
const CORNER: [Row; 13] = [
    (0.0, [-30.0, -30.0, 20.0], [0.6, 0.2, -1.0], 0.0),
    (0.5, [-30.0, -30.0, 0.0], [0.6, 0.2, -1.0], 0.0),
    (1.2, [10.0, -20.0, -2.0], [0.6, 0.0, -1.0], 0.0),
    (1.9, [48.0, -10.0, -2.0], [0.5, 0.0, -1.0], 15.0),
    (2.6, [54.0, 10.0, -3.0], [0.4, 0.3, -1.0], 45.0),
    (3.3, [54.0, 25.0, -3.0], [0.3, -0.3, -1.0], 70.0),
    (4.0, [54.0, 5.0, -3.0], [0.8, -0.3, -1.0], 90.0),
    (4.7, [54.0, -20.0, -3.0], [0.8, 0.3, -1.0], 120.0),
    (5.3, [53.0, -20.0, 10.0], [0.8, 0.0, -0.6], 120.0),
    (5.9, [52.0, 0.0, 30.0], [0.9, 0.0, -0.3], 140.0),
    (6.5, [52.0, 15.0, 20.0], [0.9, 0.3, -0.5], 160.0),
    (7.1, [53.0, 10.0, -2.0], [0.6, 0.2, -1.0], 180.0),
    (7.7, [10.0, 0.0, 20.0], [0.6, 0.0, -1.0], 180.0),
];

/// Down into the slot, along it, against one wall and the other, turned further than fits, and out.
const SLOT: [Row; 14] = [
    (0.0, [-20.0, 0.0, 20.0], [0.2, 0.0, -1.0], 0.0),
    (0.7, [-20.0, 0.0, -15.0], [0.2, 0.0, -1.0], 0.0),
    (1.2, [-10.0, 3.0, -20.0], [0.2, 0.0, -1.0], 0.0),
    (1.9, [10.0, 4.0, -20.0], [-0.1, 0.0, -1.0], 0.0),
    (2.5, [15.0, -3.0, -20.0], [-0.2, 0.0, -1.0], 0.0),
    (3.1, [0.0, -4.0, -22.0], [0.1, 0.02, -1.0], 4.0),
    (3.7, [-10.0, -3.0, -22.0], [0.2, 0.02, -1.0], -4.0),
    (4.2, [-10.0, 0.0, -22.0], [0.2, 0.0, -1.0], 12.0),
    (4.7, [-5.0, 0.0, -22.0], [0.2, 0.0, -1.0], 30.0),
    (5.2, [0.0, 2.0, -22.0], [0.2, 0.0, -1.0], 30.0),
    (5.7, [5.0, 3.0, -22.0], [0.2, 0.0, -1.0], 4.0),
    (6.2, [10.0, -2.0, -22.0], [0.1, 0.0, -1.0], 0.0),
    (6.8, [0.0, -3.0, -10.0], [0.0, 0.0, -1.0], 0.0),
    (7.5, [0.0, 0.0, 20.0], [0.1, 0.0, -1.0], 0.0),
];

/// On the star's upper face, over a point of its hull, down along two sides.
const STAR: [Row; 13] = [
    (0.0, [-10.0, -5.0, 35.0], [0.5, 0.2, -1.0], 0.0),
    (0.5, [-10.0, -5.0, 13.0], [0.5, 0.2, -1.0], 0.0),
    (1.2, [10.0, 10.0, 12.0], [0.5, 0.0, -1.0], 20.0),
    (1.9, [25.0, 0.0, 12.0], [0.3, -0.4, -1.0], 45.0),
    (2.5, [38.0, -1.0, 12.0], [-0.2, 0.0, -1.0], 60.0),
    (3.1, [42.0, -1.0, 5.0], [-0.8, 0.0, -1.0], 80.0),
    (3.8, [39.0, 1.0, -5.0], [-1.0, 0.2, -0.6], 100.0),
    (4.5, [27.0, 17.0, -2.0], [-1.0, -0.6, -0.4], 100.0),
    (5.2, [15.0, 30.0, 2.0], [-0.8, -1.0, -0.4], 120.0),
    (5.9, [6.0, 33.0, 4.0], [-0.3, -1.0, -0.6], 140.0),
    (6.5, [4.0, 26.0, 11.5], [-0.2, -0.6, -1.0], 160.0),
    (7.1, [0.0, 10.0, 12.0], [0.2, -0.3, -1.0], 180.0),
    (7.8, [0.0, 0.0, 35.0], [0.2, 0.0, -1.0], 180.0),
];

/// A loop over the flank and the top, the tool leaning this way and that.
fn around_the_ellipsoid() -> Vec<Keyframe> {
    let radii = DVec3::new(0.06, 0.05, 0.04);
    let steps = 32_u32;
    (0..=steps)
        .map(|step| {
            let part = f64::from(step) / f64::from(steps);
            let (longitude, latitude) = (2.6 * part - 0.8, 0.9 + 0.45 * (9.0 * part).sin());
            let unit = DVec3::new(
                latitude.cos() * longitude.cos(),
                latitude.cos() * longitude.sin(),
                latitude.sin(),
            );
            let normal = (unit / radii).normalize();
            // In the air at both ends, pressed in between, deeper and shallower.
            let air = 0.02 * (1.0 - (part.min(1.0 - part) * 12.0).min(1.0));
            let depth = 0.002 + 0.001 * (14.0 * part).sin();
            let lean = DVec3::new((5.0 * part).cos(), (5.0 * part).sin(), 0.0) * 0.5;
            Keyframe {
                time: 8.0 * part,
                tip: radii * unit + normal * (air - depth),
                direction: lean - normal,
                roll: 120.0 * part,
            }
        })
        .collect()
}
