//! Films of pairs that others were reported to spoil: nothing moves without need, holes stay open,
//! parts keep their identity, and players show what was made.

use morphospace::design::{Design, Truss};
use morphospace::export::{Camera, ExportTarget, FilmSpec, VectorAnimation, write_film};
use morphospace::geometry::DVec2;
use morphospace::transition::Transition;
use morphospace::work::progress::Silent;

use super::{assert_close, frame_regions, holes, imported, outline, transition};

fn svg(shapes: &str) -> Design {
    imported(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 120 90\">{shapes}</svg>"
    ))
}

/// Times at which frames are checked.
const TIMES: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

#[test]
fn the_same_ring_drawn_in_other_words_stands_still() {
    let ring =
        "M60 10A35 35 0 1 1 60 80A35 35 0 1 1 60 10ZM60 25A20 20 0 1 0 60 65A20 20 0 1 0 60 25Z";
    let same = "M60 25A20 20 0 0 0 40 45 20 20 0 0 0 60 65 20 20 0 0 0 80 45 20 20 0 0 0 60 25Z
        M25 45A35 35 0 0 1 60 10A35 35 0 0 1 95 45A35 35 0 0 1 60 80A35 35 0 0 1 25 45Z";
    let [a, b] = [ring, same].map(|path| svg(&format!("<path d=\"{path}\"/>")));
    let film = transition(&a, &b);
    let start = outline(&a);
    for t in TIMES {
        let frame = frame_regions(&film.frame(t));
        assert_eq!((frame.len(), holes(&frame)), (1, 1), "t = {t}");
        assert_close(frame.area(), start.area());
        for p in frame.rings().flat_map(|ring| ring.points()) {
            let distances = start.rings().map(|ring| ring.distance_squared(*p).sqrt());
            let distance = distances.fold(f64::INFINITY, f64::min);
            assert!(distance < 0.12, "{distance} at t = {t}");
        }
    }
}

#[test]
fn the_half_that_is_the_same_in_both_stays_where_it_is() {
    let shape = |left: &str| svg(&format!("<path d=\"{left}L110 20 100 45 110 70Z\"/>"));
    let [a, b] = [
        shape("M60 70L40 60 50 50 30 40 60 20"),
        shape("M60 70L20 75 5 45 20 15 60 20"),
    ];
    let film = transition(&a, &b);
    let [from, to] = [outline(&a), outline(&b)];
    for t in TIMES {
        let frame = frame_regions(&film.frame(t));
        for design in [&from, &to] {
            for p in design
                .rings()
                .flat_map(|ring| ring.points())
                .filter(|p| p.x > 70.0)
            {
                let rings = frame.rings();
                let distance = rings.map(|ring| ring.distance_squared(*p).sqrt());
                let distance = distance.fold(f64::INFINITY, f64::min);
                assert!(distance < 0.3, "{distance} at t = {t}");
            }
        }
    }
}

/// Asserts that no frame has crossings and that the area stays between the ends.
fn assert_area_between(film: &Transition, [low, high]: [f64; 2], slack: f64) {
    for k in 0..=20 {
        let area = frame_regions(&film.frame(f64::from(k) / 20.0)).area();
        let range = low * (1.0 - slack)..=high * (1.0 + slack);
        assert!(range.contains(&area), "{area} at {k}");
    }
}

#[test]
fn a_leaf_becomes_a_fish_without_running_beyond() {
    let leaf = svg("<path d=\"M10 45C30 5 80 5 110 45C80 85 30 85 10 45Z\"/>");
    let fish =
        svg("<path d=\"M15 45C35 15 70 20 85 40L110 20 104 45 110 70 85 50C70 70 35 75 15 45Z\"/>");
    let film = transition(&leaf, &fish);
    let areas = [outline(&leaf).area(), outline(&fish).area()];
    assert_area_between(&film, [areas[0].min(areas[1]), areas[0].max(areas[1])], 0.1);
}

#[test]
fn many_small_parts_become_one_vehicle() {
    let walkers =
        svg("<path d=\"M14 10H26V24H14ZM14 30H26V60H14ZM54 12H66V26H54ZM54 32H66V60H54Z\"/>");
    let van = svg("<path d=\"M10 30H70L90 45V65H10ZM20 68H36V80H20ZM64 68H80V80H64Z\"/>");
    let film = transition(&walkers, &van);
    let areas = [&walkers, &van].map(|design| outline(design).area());
    assert_area_between(&film, areas, 0.2);
}

#[test]
fn a_truss_with_other_node_numbers_makes_the_same_film() {
    // A braced frame of three fields; the second design leans and is wider.
    let nodes = |lean: f64, width: f64| -> Vec<DVec2> {
        (0..8)
            .map(|k| {
                let (column, row) = (f64::from(k / 2), f64::from(k % 2));
                DVec2::new(width * column + lean * row, 1.5 * row)
            })
            .collect()
    };
    let fields = (0..3).flat_map(|k: u32| {
        let [a, b, c, d] = [2 * k, 2 * k + 1, 2 * k + 2, 2 * k + 3];
        [[a, c], [b, d], [a, d], [b, c], [a, b]]
    });
    let bars: Vec<[u32; 2]> = fields.chain([[6, 7]]).collect();
    let number = |node: u32| (5 * node + 2) % 8;
    let target = nodes(0.4, 1.3);
    let mut renamed = vec![DVec2::ZERO; 8];
    for (node, p) in target.iter().enumerate() {
        renamed[number(node as u32) as usize] = *p;
    }
    let renamed_bars = bars.iter().map(|bar| bar.map(number)).collect();
    let design = |nodes, bars| Design::new("truss", Truss::new(nodes, bars).expect("a truss"));
    let source = design(nodes(0.0, 1.0), bars.clone());
    let films = [design(target, bars), design(renamed, renamed_bars)]
        .map(|target| transition(&source, &target));
    assert_eq!(films[0].frame(0.0).figure().bars.len(), 16);
    for t in TIMES {
        let [a, b] = films.each_ref().map(|film| film.frame(t).figure().bars);
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!(a.distance(*b) < 1e-9, "{a} and {b} at t = {t}");
        }
    }
    let is_reported = |note: &morphospace::transition::TransitionNote| {
        note.to_string().contains("paired by their bars")
    };
    assert!(films[1].notes().iter().any(is_reported));
    assert!(!films[0].notes().iter().any(is_reported));
}

/// Calls `visit` with the keys of each object that has a type (`ty`), in the order of the text.
fn first_keys(json: &str) -> Vec<(bool, String)> {
    let mut found = Vec::new();
    for (at, _) in json.match_indices("\"ty\":") {
        // The first key of an object follows its opening brace.
        let before = json[..at].chars().next_back();
        found.push((
            before == Some('{'),
            json[at.saturating_sub(40)..at + 5].to_owned(),
        ));
    }
    found
}

#[test]
fn shapes_of_a_lottie_film_begin_with_their_type() {
    let ring =
        svg("<path fill=\"#246\" fill-rule=\"evenodd\" d=\"M20 10H100V80H20ZM45 30H75V60H45Z\"/>");
    let bars = svg(
        "<path fill=\"#a42\" fill-rule=\"evenodd\" d=\"M20 10H100V80H20ZM30 20H55V70H30ZM65 20H90V70H65Z\"/>",
    );
    let film = transition(&ring, &bars);
    let camera = Camera::around(film, 240);
    let spec = FilmSpec::evenly(0.0, 1.0, 12, 12.0).expect("a film");
    let lottie = VectorAnimation::record(&camera, &spec, &Silent)
        .expect("an animation")
        .lottie("ring");
    let (_, shapes) = lottie.split_once("\"shapes\":").expect("shapes");
    let shapes = shapes.split("\"layers\":").next().expect("shapes");
    let types = first_keys(shapes);
    assert!(types.len() > 3);
    let late: Vec<_> = types.iter().filter(|(is_first, _)| !is_first).collect();
    // Layers have a type too, but it follows their number.
    assert!(
        late.iter().all(|(_, text)| text.contains("\"ind\":")),
        "{late:?}"
    );
}

#[test]
fn still_pixels_of_a_gif_stay_and_faint_changes_arrive() {
    // A faint square appears on the left, and a bar moves on the right.
    let [a, b] = [("#f4f4f4", 70), ("#e8e8e8", 85)].map(|(faint, x)| {
        svg(&format!(
            "<rect width=\"120\" height=\"90\" fill=\"#ffffff\"/>
             <rect x=\"10\" y=\"20\" width=\"30\" height=\"30\" fill=\"{faint}\"/>
             <rect x=\"{x}\" y=\"20\" width=\"20\" height=\"50\" fill=\"#2255aa\"/>"
        ))
    });
    let camera = Camera {
        ground: Some("#ffffff".parse().expect("a colour")),
        ..Camera::around(transition(&a, &b), 240)
    };
    let film = FilmSpec::evenly(0.0, 1.0, 24, 25.0).expect("a film");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("film.gif");
    let target = ExportTarget::of_path(&path)
        .expect("a target")
        .preferring_film();
    write_film(&camera, &film, &target, &Silent).expect("written");
    let frames = gif_frames(&path);
    assert_eq!(frames.len(), 24);
    let far = |a: [u8; 3], b: [u8; 3]| a.iter().zip(b).map(|(a, b)| a.abs_diff(b)).max();
    let [width, height] = [camera.view.size().width(), camera.view.size().height()];
    // Pixels that are white in each exact frame, such as the corners, and those of the square.
    let exact: Vec<_> = film.times().iter().map(|&t| camera.pixels(t)).collect();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let index = (y * width + x) as usize;
        let mut pixels = exact.iter().map(|frame| frame.get_pixel(x, y).0);
        let is_ground = pixels.all(|pixel| pixel == [255; 4]);
        let shown = frames.iter().map(|frame| frame[index]);
        let moved = shown.map(|pixel| far(pixel, frames[0][index])).max();
        let moved = moved.flatten();
        assert!(
            !is_ground || moved <= Some(8),
            "({x}, {y}) changes by {moved:?}"
        );
    }
    let last = &exact[23];
    let faint = last
        .enumerate_pixels()
        .filter(|(_, _, pixel)| pixel.0 == [232, 232, 232, 255]);
    let faint: Vec<_> = faint.map(|(x, y, _)| (y * width + x) as usize).collect();
    assert!(faint.len() > 1000, "{}", faint.len());
    for index in faint {
        assert!(
            far(frames[23][index], [232; 3]) <= Some(4),
            "{:?}",
            frames[23][index]
        );
    }
}

/// Colours of all pixels of each frame of a GIF, as players show them.
fn gif_frames(path: &std::path::Path) -> Vec<Vec<[u8; 3]>> {
    let mut options = gif::DecodeOptions::new();
    options.set_color_output(gif::ColorOutput::RGBA);
    let file = std::fs::File::open(path).expect("opened");
    let mut decoder = options.read_info(file).expect("a GIF");
    let [width, height] = [decoder.width(), decoder.height()].map(usize::from);
    let mut canvas = vec![[0; 3]; width * height];
    let mut frames = Vec::new();
    while let Some(frame) = decoder.read_next_frame().expect("a frame") {
        let [left, top, columns] = [frame.left, frame.top, frame.width].map(usize::from);
        for (k, pixel) in frame.buffer.chunks_exact(4).enumerate() {
            if pixel[3] > 0 {
                let at = (top + k / columns) * width + left + k % columns;
                canvas[at] = [pixel[0], pixel[1], pixel[2]];
            }
        }
        frames.push(canvas.clone());
    }
    frames
}
