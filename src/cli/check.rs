//! `morphospace check`: a transition in numbers.
//!
//! With `--json` one object on stdout; lengths and areas are in the units of
//! the designs, angles in degrees, times in seconds. A number that is infinite
//! (a folded face is infinitely distorted) is `null`, as JSON has no other way.

use std::time::{Duration, Instant};

use clap::Args;
use serde::Serialize;
use serde_json::Value;

use crate::content::{Content, ContentKind};
use crate::design::Form;
use crate::measure::{self, FilmReport, MeshReport};
use crate::progress::Progress;
use crate::transition::Transition;
use crate::warp::WarpKind;

use super::error::CliError;
use super::inputs::{Inputs, Opened};
use super::options::MethodArgs;
use super::output;
use super::terminal::Terminal;

/// Frames whose times are taken.
const TIMED_FRAMES: usize = 15;

#[derive(Debug, Args)]
pub(super) struct CheckArgs {
    #[command(flatten)]
    inputs: Inputs,

    /// At how many values of t, evenly from 0 to 1, the film is measured
    #[arg(long, value_name = "N", default_value_t = 33, value_parser = clap::value_parser!(u64).range(2..=10_000))]
    samples: u64,

    /// One JSON object instead of a table
    #[arg(long)]
    json: bool,

    #[command(flatten)]
    method: MethodArgs,
}

/// Everything that is measured.
#[derive(Debug, Serialize)]
struct Report {
    title: String,
    warp: WarpKind,
    content: ContentKind,
    designs: Vec<DesignReport>,
    /// Vertices of the common triangulation.
    vertices: Option<usize>,
    /// Its faces.
    faces: Option<usize>,
    /// Width and height of the fields' grid.
    grid: Option<[u32; 2]>,
    seconds: Seconds,
    mesh: Option<MeshReport>,
    film: FilmReport,
}

#[derive(Debug, Serialize)]
struct DesignReport {
    name: String,
    kind: &'static str,
    /// Points of its outline, vertices of its mesh or nodes of its truss.
    points: usize,
}

/// How long each stage took.
#[derive(Debug, Serialize)]
struct Seconds {
    /// Reading and importing the designs.
    import: f64,
    /// Building the transition.
    build: f64,
    /// Moving a frame to another t, the median of some.
    frame: f64,
    /// Evaluating it as polygons, likewise.
    figure: f64,
    /// Measuring all that is reported here.
    measure: f64,
}

pub(super) fn run(args: &CheckArgs) -> Result<(), CliError> {
    let terminal = Terminal::new();
    let opened = args.inputs.open(&args.method, &terminal)?;
    let report = report(&opened, args.samples as usize, &terminal)?;
    drop(terminal);
    let value = serde_json::to_value(&report).map_err(CliError::failed)?;
    let text = if args.json {
        format!("{value:#}\n")
    } else {
        table(&value)
    };
    output::data(&text)
}

fn report(opened: &Opened, samples: usize, progress: &dyn Progress) -> Result<Report, CliError> {
    let transition = &opened.transition;
    let (frame, figure) = frame_times(transition);
    let start = Instant::now();
    let mesh = transition.compatible();
    let mesh_report = mesh.and_then(measure::mesh);
    let film = measure::film(transition, samples, progress).map_err(CliError::failed)?;
    let grid = match transition.content() {
        Content::Field(pair) => Some([pair.grid().width, pair.grid().height]),
        Content::Solid(_) => None,
    };
    Ok(Report {
        title: opened.loaded.title(),
        warp: transition.cell().warp(),
        content: transition.cell().content(),
        designs: designs(transition),
        vertices: mesh.map(|mesh| mesh.source().len()),
        faces: mesh.map(|mesh| mesh.faces().len()),
        grid,
        seconds: Seconds {
            import: opened.import_time.as_secs_f64(),
            build: opened.build_time.as_secs_f64(),
            frame: frame.as_secs_f64(),
            figure: figure.as_secs_f64(),
            measure: start.elapsed().as_secs_f64(),
        },
        mesh: mesh_report,
        film,
    })
}

fn designs(transition: &Transition) -> Vec<DesignReport> {
    let of_design = |design: &std::sync::Arc<crate::design::Design>| {
        let (kind, points) = match &design.form {
            Form::Outline(regions) => {
                let points = regions.rings().map(|ring| ring.points().len()).sum();
                ("outline", points)
            }
            Form::Mesh(mesh) => ("mesh", mesh.positions().len()),
            Form::Truss(truss) => ("truss", truss.nodes().len()),
        };
        DesignReport {
            name: design.name.clone(),
            kind,
            points,
        }
    };
    transition.designs().iter().map(of_design).collect()
}

/// Median times of moving a frame and of evaluating it.
fn frame_times(transition: &Transition) -> (Duration, Duration) {
    let mut frame = transition.frame(0.0);
    let timed = (0..TIMED_FRAMES).map(|i| {
        let start = Instant::now();
        frame.seek((i as f64 + 0.5) / TIMED_FRAMES as f64);
        let moved = start.elapsed();
        let start = Instant::now();
        std::hint::black_box(frame.figure());
        (moved, start.elapsed())
    });
    let (frames, figures): (Vec<_>, Vec<_>) = timed.unzip();
    (median(frames), median(figures))
}

fn median(mut times: Vec<Duration>) -> Duration {
    times.sort_unstable();
    times.get(times.len() / 2).copied().unwrap_or_default()
}

/// Columns of the table of samples, and where a sample has them.
const COLUMNS: [(&str, &str); 8] = [
    ("t", "/t"),
    ("area", "/area"),
    ("perimeter", "/perimeter"),
    ("pieces", "/pieces"),
    ("holes", "/holes"),
    ("crossings", "/crossings"),
    ("folds", "/distortion/folds"),
    ("conformal", "/distortion/conformal/worst"),
];

/// A line for each number, named by its place in the JSON; then a table of the
/// film's samples.
fn table(report: &Value) -> String {
    let mut rows = Vec::new();
    flatten("", report, &mut rows);
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    let line = |(name, value): &(String, String)| format!("{name:width$}  {value}\n");
    let numbers: String = rows.iter().map(line).collect();
    let samples = report.pointer("/film/samples").and_then(Value::as_array);
    format!(
        "{numbers}\n{}",
        samples_table(samples.map_or(&[], Vec::as_slice))
    )
}

fn samples_table(samples: &[Value]) -> String {
    let is_known = |place: &str| {
        samples
            .iter()
            .any(|s| s.pointer(place).is_some_and(|v| !v.is_null()))
    };
    let columns = COLUMNS.iter().filter(|(_, place)| is_known(place));
    let cells = |of: &dyn Fn(&(&str, &str)) -> String| -> String {
        let cells: Vec<_> = columns
            .clone()
            .map(|column| format!("{:>12}", of(column)))
            .collect();
        cells.concat() + "\n"
    };
    let row =
        |sample: &Value| cells(&|(_, place)| sample.pointer(place).map_or_else(String::new, plain));
    let header = cells(&|(name, _)| (*name).to_owned());
    header + &samples.iter().map(row).collect::<String>()
}

fn flatten(name: &str, value: &Value, rows: &mut Vec<(String, String)>) {
    let below = |key: &str| {
        let dot = if name.is_empty() { "" } else { "." };
        format!("{name}{dot}{}", key.replace('_', " "))
    };
    match value {
        Value::Null => {}
        Value::Object(object) => {
            for (key, value) in object {
                flatten(&below(key), value, rows);
            }
        }
        Value::Array(_) if name == "film.samples" => {}
        Value::Array(values) if values.iter().all(Value::is_object) => {
            for (i, value) in values.iter().enumerate() {
                flatten(&format!("{name}.{i}"), value, rows);
            }
        }
        Value::Array(values) => {
            let values: Vec<_> = values.iter().map(plain).collect();
            rows.push((name.to_owned(), values.join(" x ")));
        }
        value => rows.push((name.to_owned(), plain(value))),
    }
}

/// Numbers to six digits, words without quotes.
fn plain(value: &Value) -> String {
    match value {
        Value::String(words) => words.clone(),
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().unwrap_or_default();
            if x != 0.0 && !(1e-4..1e7).contains(&x.abs()) {
                format!("{x:.3e}")
            } else {
                let fixed = format!("{x:.6}");
                fixed.trim_end_matches('0').trim_end_matches('.').to_owned()
            }
        }
        Value::Null => "-".to_owned(),
        value => value.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_table_names_each_number() {
        let report = json!({
            "title": "a to b", "vertices": null, "grid": [3, 4],
            "film": {"worst_folds": 0, "asymmetry": 1.5e-12, "samples": [
                {"t": 0.0, "area": 2.5, "holes": null, "distortion": {"folds": 7}},
            ]},
        });
        let table = table(&report);
        let lines: Vec<&str> = table.lines().map(str::trim_end).collect();
        assert_eq!(
            lines,
            [
                "film.asymmetry    1.500e-12",
                "film.worst folds  0",
                "grid              3 x 4",
                "title             a to b",
                "",
                "           t        area       folds",
                "           0         2.5           7",
            ]
        );
    }

    #[test]
    fn the_median_is_the_middle() {
        let ms = Duration::from_millis;
        assert_eq!(median(vec![ms(9), ms(1), ms(2)]), ms(2));
        assert_eq!(median(vec![]), Duration::ZERO);
    }
}
