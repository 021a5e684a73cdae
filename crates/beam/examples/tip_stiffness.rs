//! How stiff the catalogue's tools are at their tips, and how far small-deflection theory carries: linear deflection against that of
//! co-rotational elements, in percent of the length: `cargo run --release -p pliant-beam --example tip_stiffness`.
#![expect(clippy::print_stdout, reason = "an example prints what it found")]

use std::error::Error;

use glam::DVec3;
use pliant_beam::{
    AnchoredLoads, Beam, ClosedForm, Corotational, Load, Loading, Settings, catalogue,
};

/// At the tip, across [N].
const FORCES: [f64; 3] = [0.1, 0.3, 1.0];

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:76} deflection by length [%]: linear -> far", "");
    print!("{:24}{:>10}{:>13}", "tool", "length", "EI at root");
    print!("{:>13}{:>15}", "stiffness", "force for 10 %");
    for force in FORCES {
        print!("{:>20}", format!("{force} N"));
    }
    println!();
    print!("{:24}{:>10}{:>13}", "", "[mm]", "[N mm²]");
    println!("{:>13}{:>15}", "[N/mm]", "[N]");
    for entry in catalogue() {
        let beam = Beam::new(entry.spec())?;
        let material = beam.spec().material;
        let root = beam.shape_at(0.0).section(material.poisson_ratio());
        let stiffness = tip_stiffness(&beam)?;
        print!(
            "{:24}{:>10}{:>13}{:>13}{:>15}",
            entry.name,
            digits(beam.length() * 1e3),
            digits(material.young_modulus * root.second_moment_y * 1e6),
            digits(stiffness * 1e-3),
            digits(stiffness * 0.1 * beam.length()),
        );
        for force in FORCES {
            let linear = 100.0 * force / stiffness / beam.length();
            let far = far_deflection(&beam, force)
                .map_or_else(|| "not held".to_owned(), |far| digits(100.0 * far));
            print!("{:>20}", format!("{} -> {far}", digits(linear)));
        }
        println!();
    }
    Ok(())
}

/// Force across the tip per deflection there [N/m].
fn tip_stiffness(beam: &Beam) -> Result<f64, &'static str> {
    let closed_form = ClosedForm::new(beam).ok_or("tools of the catalogue are straight")?;
    let tip = closed_form.station(beam.length());
    Ok(1.0 / tip.compliance(&tip).translation_force.z_axis.z)
}

/// Deflection of the tip along a force that keeps its direction, by the length; `None` where no shape was found that holds it.
fn far_deflection(beam: &Beam, force: f64) -> Option<f64> {
    let load = Load {
        s: beam.length(),
        force: DVec3::Z * force,
        moment: DVec3::ZERO,
    };
    let loading = Loading {
        points: &[load],
        line: DVec3::ZERO,
    };
    let loads = AnchoredLoads::new(beam, &loading, &[]);
    let mut bent = Corotational::new(beam.clone());
    let outcome = bent.solve(&loads, &Settings::default());
    let tip = bent.node(beam.elements().len()).translation;
    outcome.converged.then_some(tip.z / beam.length())
}

/// Three significant digits.
fn digits(value: f64) -> String {
    let short = format!("{value:.2e}");
    match short.parse::<f64>() {
        Ok(rounded) if rounded >= 1e-3 => rounded.to_string(),
        _ => short,
    }
}
