//! Every tick as a line of CSV. Equal runs give equal bytes: no clock reading, numbers printed to the last bit.

use std::fmt::Write as _;

use glam::DVec3;
use pliant_servo::Sample;
use pliant_spatial::Pose;

use crate::failure::Failure;
use crate::output::PendingFile;

const COLUMNS: &str = "t_s,haptic_x_m,haptic_y_m,haptic_z_m,haptic_qx,haptic_qy,haptic_qz,haptic_qw,\
visual_x_m,visual_y_m,visual_z_m,visual_qx,visual_qy,visual_qz,visual_qw,\
force_x_n,force_y_n,force_z_n,torque_x_nm,torque_y_nm,torque_z_nm,\
contacts,contact_object,contact_element,tip_deflection_m,energy_j,held,fallback\n";

/// Deflection of the tip against the visual handle [m]: none, the tool is rigid.
const TIP_DEFLECTION: f64 = 0.0;

/// What the head of a table says.
pub(crate) struct Head<'a> {
    pub(crate) scene: &'a str,
    pub(crate) method: &'a str,
    pub(crate) rate_hz: u32,
    /// Settings in force, each after `, `.
    pub(crate) settings: String,
    /// Names of the objects.
    pub(crate) objects: &'a [String],
}

/// The table in the making.
pub(crate) struct Trace {
    file: PendingFile,
    /// Names of the objects, as fields of the table.
    objects: Vec<String>,
    line: String,
}

impl Trace {
    /// Writes the head: a comment that names the run, and the columns.
    pub(crate) fn new(mut file: PendingFile, head: &Head<'_>) -> Result<Self, Failure> {
        let Head {
            scene,
            method,
            rate_hz,
            settings,
            objects,
        } = head;
        let version = env!("CARGO_PKG_VERSION");
        let head = format!(
            "# scene {scene}, method {method}, rate {rate_hz} Hz, pliant {version}{settings}\n{COLUMNS}"
        );
        file.write(head.as_bytes())?;
        Ok(Self {
            file,
            objects: objects.iter().map(|name| field(name)).collect(),
            line: String::new(),
        })
    }

    /// Adds one tick.
    pub(crate) fn add(&mut self, sample: &Sample) -> Result<(), Failure> {
        let output = &sample.output;
        self.line.clear();
        let _ = write!(self.line, "{:?}", sample.time);
        self.pose(&output.world_from_haptic);
        self.pose(&output.world_from_visual);
        self.vector(output.wrench.force);
        self.vector(output.wrench.torque);
        let _ = write!(self.line, ",{}", output.contacts);
        let _ = match output.contact {
            Some(contact) => {
                let object = self.objects.get(contact.object as usize);
                let object = object.map_or("", String::as_str);
                write!(self.line, ",{object},{}", contact.segment)
            }
            None => write!(self.line, ",,"),
        };
        let _ = writeln!(
            self.line,
            ",{TIP_DEFLECTION:?},{:?},{},{}",
            output.coupling_energy,
            u8::from(output.held),
            u8::from(output.capped)
        );
        self.file.write(self.line.as_bytes())
    }

    /// Puts the table in its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        self.file.finish()
    }

    fn pose(&mut self, pose: &Pose) {
        self.vector(pose.translation);
        let q = pose.rotation;
        let _ = write!(self.line, ",{:?},{:?},{:?},{:?}", q.x, q.y, q.z, q.w);
    }

    fn vector(&mut self, v: DVec3) {
        let _ = write!(self.line, ",{:?},{:?},{:?}", v.x, v.y, v.z);
    }
}

/// A name as a field: in quotes where it holds what ends a field or a line (RFC 4180).
fn field(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::field;

    #[test]
    fn names_that_would_break_a_table_are_quoted() {
        assert_eq!(field("box"), "box");
        assert_eq!(field("box, left"), "\"box, left\"");
        assert_eq!(field("12\" pipe"), "\"12\"\" pipe\"");
        assert_eq!(field("a\nb"), "\"a\nb\"");
    }
}
