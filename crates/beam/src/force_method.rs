//! Linear statics without a matrix: forces from tip to root, displacements from root to tip (beam.13).
//!
//! A clamped beam is statically determinate, so what each section bears is known before anything has moved; one sweep sums it up and
//! one integrates the flexibilities of the elements. Some forty operations an element, and no digit lost to short elements.

use crate::beam::Beam;

/// A straight beam ready for loads at its nodes.
#[derive(Clone, Debug)]
pub struct ForceMethod {
    elements: Vec<Element>,
    /// Force and moment on the far end of each element.
    ends: Vec<[f64; 6]>,
}

/// Length and what the far end does relative to the near one, clamped.
#[derive(Clone, Copy, Debug)]
struct Element {
    length: f64,
    /// u per `f_x`, `r_x` per `m_x`.
    axial: f64,
    torsion: f64,
    about_y: Cantilever,
    about_z: Cantilever,
}

/// Of one plane.
#[derive(Clone, Copy, Debug)]
struct Cantilever {
    /// Deflection per force [m/N].
    deflection: f64,
    /// Rotation per force and deflection per moment [1/N].
    mixed: f64,
    /// Rotation per moment [1/(N·m)].
    rotation: f64,
}

impl ForceMethod {
    /// `None` for a beam bent at rest.
    pub fn new(beam: &Beam) -> Option<Self> {
        let cantilever = |[zeroth, first, second]: [f64; 3], shear: f64, length: f64| Cantilever {
            deflection: length * length * (zeroth - 2.0 * first + second) + shear,
            mixed: length * (zeroth - first),
            rotation: zeroth,
        };
        let elements: Vec<_> = beam
            .elements()
            .iter()
            .map(|element| {
                let (own, length) = (&element.flexibility, element.arc);
                Element {
                    length,
                    axial: own.axial,
                    torsion: own.torsion,
                    about_y: cantilever(own.bending_y, own.shear_z, length),
                    about_z: cantilever(own.bending_z, own.shear_y, length),
                }
            })
            .collect();
        beam.is_straight().then(|| Self {
            ends: vec![[0.0; 6]; elements.len()],
            elements,
        })
    }

    /// Displacements and rotations of the free nodes, in place of the forces and moments on them (`f_x`, `f_y`, `f_z`, `m_x`, `m_y`, `m_z`), in
    /// the root's frame. Allocates nothing.
    ///
    /// # Panics
    /// When `nodes` are not as many as elements.
    pub fn solve(&mut self, nodes: &mut [[f64; 6]]) {
        assert_eq!(nodes.len(), self.elements.len(), "one load per free node");
        let mut sum = [0.0; 6];
        let mut length = 0.0;
        for ((element, end), load) in self.elements.iter().zip(&mut self.ends).zip(&*nodes).rev() {
            // x × f on the way over the element before.
            sum[4] -= length * sum[2];
            sum[5] += length * sum[1];
            for (sum, load) in sum.iter_mut().zip(load) {
                *sum += load;
            }
            *end = sum;
            length = element.length;
        }
        let mut at = [0.0; 6];
        for ((element, end), node) in self.elements.iter().zip(&self.ends).zip(nodes) {
            let [fx, fy, fz, mx, my, mz] = *end;
            let (y, z) = (&element.about_y, &element.about_z);
            let [u, v, w, rx, ry, rz] = at;
            at = [
                u + element.axial * fx,
                v + element.length * rz + z.deflection * fy + z.mixed * mz,
                w - element.length * ry + y.deflection * fz - y.mixed * my,
                rx + element.torsion * mx,
                ry - y.mixed * fz + y.rotation * my,
                rz + z.mixed * fy + z.rotation * mz,
            ];
            *node = at;
        }
    }
}
