//! `morphospace check --structure`: statics of trusses and of their in-betweens, and trusses at
//! chosen t as files.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::Args;
use serde::Serialize;

use crate::io::atomic_file;
use crate::io::escape::csv_line;
use crate::structure::{
    BarResults, FilmStructure, NodeList, SizingOptions, StructureLimits, StructureSample,
    StructureTables, TransitionStructure,
};
use crate::transition::{Sequence, Transition};
use crate::work::progress::{OverallProgress, Progress, ProgressSpan};

use super::error::CliError;
use super::inputs::InputArgs;
use super::laboratory::{NumberLines, short};
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;

/// Number of t that the table lists (heuristic).
const ROWS: usize = 9;

/// Progress reported once the transition is analysed, in [0, 1]; sizing takes the rest (heuristic).
const ANALYSED_FRACTION: f64 = 0.7;

#[derive(Debug, Args)]
pub(super) struct StructureArgs {
    /// Analyse trusses as structures: forces, deflection, buckling, frequency and mass between the
    /// designs, and whether they stand at every t
    #[arg(long, conflicts_with_all = ["pairs", "map"])]
    pub structure: bool,

    /// With --structure: print all numbers of each bar and node at these t
    #[arg(
        long,
        value_name = "T",
        requires = "structure",
        allow_negative_numbers = true,
        value_delimiter = ','
    )]
    at: Vec<f64>,

    /// With --structure and --at: write the numbers of each bar to this CSV file
    #[arg(long, value_name = "PATH.csv", requires = "at")]
    members: Option<PathBuf>,
}

/// Structure of one transition.
#[derive(Debug, Serialize)]
struct StructureReport {
    title: String,
    /// Number of bars.
    bars: usize,
    /// Number of nodes.
    nodes: usize,
    #[serde(flatten)]
    film: FilmStructure,
    /// Mass in kg of the structure with sized members, at evenly spaced t; empty for structures
    /// that are too large to be sized.
    sized: Vec<SizedMass>,
    /// Time in s of analysing all samples, proof included.
    seconds: f64,
    /// All numbers at the t of `--at`.
    tables: Vec<StructureTables>,
}

/// Mass of the structure with sized members.
#[derive(Debug, Serialize)]
struct SizedMass {
    t: f64,
    /// Mass in kg; `None` if the structure is a mechanism or has no loads.
    mass: Option<f64>,
}

impl StructureArgs {
    /// Analyses all segments and prints the results.
    pub(super) fn check(
        &self,
        inputs: &InputArgs,
        method: &MethodArgs,
        as_json: bool,
    ) -> Result<(), CliError> {
        if let Some(t) = self.at.iter().find(|t| !t.is_finite()) {
            return Err(CliError::Usage(format!(
                "--at {t} is invalid: t must be a finite number"
            )));
        }
        let terminal = Terminal::new();
        let overall = OverallProgress::new(&terminal);
        let input = inputs.read(method, &overall)?;
        input.files.check_outputs(&self.members)?;
        let mut reports = Vec::new();
        let building = ProgressSpan::new(&overall, 0.0, 0.5);
        let analysing = ProgressSpan::new(&overall, 0.5, 1.0);
        input.open_each(&building, |opened| {
            reports.push(StructureReport::of(
                opened.title(),
                &opened.transition,
                &analysing,
            )?);
            let structure = TransitionStructure::new(&opened.transition);
            let index = reports.len() - 1;
            let mut structure = structure.map_err(CliError::failed)?;
            // The t of a sequence counts its designs.
            let within = |t: &&f64| (index as f64..=index as f64 + 1.0).contains(*t);
            let is_only = !opened.loaded.is_segment();
            let times = self.at.iter().filter(|t| is_only || within(t));
            reports[index].tables = times
                .map(|t| structure.tables(t - if is_only { 0.0 } else { index as f64 }))
                .collect();
            Ok(())
        })?;
        if let Some(path) = &self.members {
            let tables = reports.iter().flat_map(|report| &report.tables);
            write_members(path, tables)?;
        }
        drop(terminal);
        output::write_data(&match reports.as_slice() {
            [report] if as_json => output::json(report)?,
            reports if as_json => output::json(&reports)?,
            reports => {
                let texts: Vec<String> = reports.iter().map(StructureReport::text).collect();
                texts.join("\n")
            }
        })?;
        if let Some(path) = &self.members {
            output::message(&format!("wrote {}", path.display()));
        }
        Ok(())
    }
}

/// Writes the numbers of all bars as CSV.
fn write_members<'a>(
    path: &Path,
    tables: impl Iterator<Item = &'a StructureTables>,
) -> Result<(), CliError> {
    let mut csv = csv_line([
        "t",
        "bar",
        "first_node",
        "second_node",
        "length_m",
        "area_m2",
        "axial_n",
        "shear_n",
        "moment_nm",
        "stress_pa",
        "utilisation",
        "euler_utilisation",
        "slenderness",
    ]);
    for table in tables {
        for bar in &table.bars {
            csv.extend(csv_line(cells(table.t, bar)));
        }
    }
    write_file(path, &csv)
}

/// Writes a file at once; a failure leaves an existing file as it was.
fn write_file(path: &Path, bytes: &[u8]) -> Result<(), CliError> {
    atomic_file::write(path, bytes).map_err(|error| {
        let reason = atomic_file::write_error_message(&error);
        CliError::Failed(format!("cannot write `{}`: {reason}", path.display()))
    })
}

/// Returns the cells of the CSV row of a bar.
fn cells(t: f64, bar: &BarResults) -> Vec<String> {
    let optional = |value: Option<f64>| value.map_or_else(String::new, |value| value.to_string());
    vec![
        t.to_string(),
        bar.bar.to_string(),
        bar.first_node.to_string(),
        bar.second_node.to_string(),
        bar.length_m.to_string(),
        bar.area_m2.to_string(),
        bar.axial_n.to_string(),
        bar.shear_n.to_string(),
        bar.moment_nm.to_string(),
        bar.stress_pa.to_string(),
        bar.utilisation.to_string(),
        optional(bar.euler_utilisation),
        optional(bar.slenderness),
    ]
}

/// Writes the truss of a sequence at `t`.
///
/// # Errors
/// If the designs are no trusses, the truss at `t` is invalid, or the file cannot be written.
pub(super) fn write_truss(sequence: &Sequence, t: f64, path: &Path) -> Result<(), CliError> {
    let (index, t) = sequence.segment_at(t);
    let mut structure =
        TransitionStructure::new(&sequence.segments()[index]).map_err(CliError::failed)?;
    let truss = structure.truss(t).map_err(CliError::failed)?;
    write_file(path, truss.to_json().as_bytes())
}

impl StructureReport {
    fn of(
        title: String,
        transition: &Transition,
        progress: &dyn Progress,
    ) -> Result<Self, CliError> {
        let [analysing, sizing] = [(0.0, ANALYSED_FRACTION), (ANALYSED_FRACTION, 1.0)]
            .map(|(from, to)| ProgressSpan::new(progress, from, to));
        let limits = StructureLimits::default();
        let start = Instant::now();
        let film = FilmStructure::of(transition, FilmStructure::SAMPLES, &limits, &analysing)
            .map_err(CliError::failed)?;
        let seconds = start.elapsed().as_secs_f64();
        let mut structure = TransitionStructure::new(transition).map_err(CliError::failed)?;
        let options = SizingOptions::default();
        // Sizing analyses each t many times, so that large structures would take minutes.
        let is_large = film.samples.len() < FilmStructure::SAMPLES;
        let sized_rows = if is_large { 0 } else { ROWS };
        let sized = (0..sized_rows).map(|row| {
            let t = row as f64 / (ROWS - 1) as f64;
            let sized = structure
                .sized(t, &options, &sizing)
                .map_err(CliError::failed)?;
            let mass = sized.map(|sized| sized.mass);
            Ok(SizedMass { t, mass })
        });
        let sized = sized.collect::<Result<_, CliError>>()?;
        let blend = structure.blend();
        Ok(Self {
            title,
            bars: blend.bars().len(),
            nodes: blend.node_count(),
            film,
            sized,
            seconds,
            tables: Vec::new(),
        })
    }

    /// Returns the report as text: the faults, then a table of measures.
    fn text(&self) -> String {
        let mut lines = NumberLines::default();
        lines.line(&self.title);
        lines.gap();
        let row = |lines: &mut NumberLines, name: &str, text: &str| {
            lines.line(&format!("{name:<12} {text}"));
        };
        row(
            &mut lines,
            "structure",
            &format!("{} bars, {} nodes", self.bars, self.nodes),
        );
        row(&mut lines, "stability", &self.stability());
        let count = self.film.findings.len();
        let summary = match count {
            0 => "sound: no fault found".to_owned(),
            1 => "1 fault".to_owned(),
            count => format!("{count} faults, the gravest first"),
        };
        row(
            &mut lines,
            "check",
            &format!("{summary} ({} values of t)", self.film.samples.len()),
        );
        for finding in &self.film.findings {
            row(&mut lines, "", &finding.to_string());
        }
        if self.sized.is_empty() {
            row(
                &mut lines,
                "note",
                "members were not sized, because there are too many",
            );
        }
        for note in &self.film.notes {
            row(&mut lines, "note", note);
        }
        row(
            &mut lines,
            "note",
            "a concept check without partial factors, not a check by a building code",
        );
        lines.gap();
        self.table(&mut lines);
        for table in &self.tables {
            lines.gap();
            bars_text(table, &mut lines);
        }
        lines.0
    }

    /// Returns in words whether the structure stands at every t.
    fn stability(&self) -> String {
        match &self.film.proof {
            None => "not examined between the analysed t, because the motion cannot be recorded"
                .to_owned(),
            Some(proof) => match proof.fails_at {
                None => format!(
                    "stands at every t: proved on {} intervals of t with {} factorisations",
                    proof.intervals, proof.factorisations
                ),
                Some(t) => {
                    let verb = if proof.is_mechanism {
                        "falls over"
                    } else {
                        "not proved to stand"
                    };
                    let nodes = NodeList(&proof.moving_nodes);
                    format!("{verb} at t = {t:.6}; moves most easily at {nodes}")
                }
            },
        }
    }

    /// Adds the measures at some t.
    fn table(&self, lines: &mut NumberLines) {
        lines.cells(
            ("t", 8),
            [
                "mass kg",
                "deflection",
                "span/",
                "strength",
                "Euler",
                "buckling",
                "f1 Hz",
                "energy J",
                "sized kg",
            ],
        );
        lines.cells(
            ("", 8),
            ["", "mm", "deflection", "used", "used", "factor", "", "", ""],
        );
        let step = (self.film.samples.len() - 1) / (ROWS - 1);
        for (row, sample) in self.film.samples.iter().step_by(step).enumerate() {
            let t = format!("{:.3}", sample.t);
            let mass = self.sized.get(row).and_then(|sized| sized.mass);
            lines.cells((&t, 8), measures(sample, mass));
        }
    }
}

/// Returns a share as a whole percentage.
fn percentage(share: f64) -> String {
    format!("{} %", short((100.0 * share).round()))
}

/// Returns the cells of the measures at one t.
fn measures(sample: &StructureSample, sized: Option<f64>) -> [String; 9] {
    let number = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), short);
    let percent = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), percentage);
    let deflects = sample.deflection > 0.0;
    [
        short(sample.mass),
        number(sample.stands().then_some(1e3 * sample.deflection)),
        number(deflects.then(|| (sample.span / sample.deflection).round())),
        percent(sample.strength.map(|v| v.value)),
        percent(sample.euler.map(|v| v.value)),
        number(sample.critical_load_factor),
        number(sample.frequency),
        number(sample.stands().then_some(sample.compliance)),
        number(sized),
    ]
}

/// Adds the numbers of all bars at one t.
fn bars_text(table: &StructureTables, lines: &mut NumberLines) {
    lines.line(&format!("bars at t = {:.3}", table.t));
    lines.cells(
        ("bar", 12),
        [
            "length m",
            "area mm²",
            "axial kN",
            "moment kNm",
            "stress MPa",
            "strength",
            "Euler",
            "slenderness",
        ],
    );
    for bar in &table.bars {
        let name = format!("{} ({}-{})", bar.bar, bar.first_node, bar.second_node);
        let optional = |text: Option<String>| text.unwrap_or_else(|| "-".to_owned());
        lines.cells(
            (&name, 12),
            [
                short(bar.length_m),
                short(1e6 * bar.area_m2),
                short(1e-3 * bar.axial_n),
                short(1e-3 * bar.moment_nm),
                short(1e-6 * bar.stress_pa),
                percentage(bar.utilisation),
                optional(bar.euler_utilisation.map(percentage)),
                optional(
                    bar.slenderness
                        .map(|slenderness| short(slenderness.round())),
                ),
            ],
        );
    }
}
