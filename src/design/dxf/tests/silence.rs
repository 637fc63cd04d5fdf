//! Tests that no entity type of the DXF Reference is lost without a note.

use super::*;

/// Entity types of the DXF Reference (releases 12 to 2018) and of common extensions that are not
/// drawn.
const UNSUPPORTED: [&str; 40] = [
    "3DSOLID",
    "ACAD_PROXY_ENTITY",
    "ALIGNMENT",
    "BODY",
    "CAMERA",
    "COORDINATIONMODEL",
    "DGNUNDERLAY",
    "DWFUNDERLAY",
    "EXTRUDEDSURFACE",
    "GEOMAPIMAGE",
    "GEOPOSITIONMARKER",
    "IMAGE",
    "JUMP",
    "LIGHT",
    "LOFTEDSURFACE",
    "MESH",
    "MLEADER",
    "MULTILEADER",
    "NURBSURFACE",
    "OLE2FRAME",
    "OLEFRAME",
    "PDFUNDERLAY",
    "PLANESURFACE",
    "POINT",
    "POINTCLOUD",
    "POINTCLOUDEX",
    "RAY",
    "REGION",
    "REVOLVEDSURFACE",
    "RTEXT",
    "SECTION",
    "SHAPE",
    "SUN",
    "SURFACE",
    "SWEPTSURFACE",
    "TABLE",
    "TOLERANCE",
    "WIPEOUT",
    "XLINE",
    "UNKNOWN_TYPE",
];

/// Entities that are drawn approximately, with the feature that is approximated.
const APPROXIMATED: [(&str, &str); 7] = [
    (
        "POLYLINE 66 1 70 16 0 VERTEX 10 1 20 1 70 64 0 SEQEND",
        "meshes in space",
    ),
    (
        "POLYLINE 66 1 70 64 0 VERTEX 10 1 20 1 70 192 0 SEQEND",
        "meshes in space",
    ),
    (
        "HATCH 2 EARTH 70 0 91 1 92 2 93 3 10 50 20 0 10 60 20 0 10 60 20 9 97 0 75 0",
        "the pattern EARTH",
    ),
    ("LEADER 71 1 10 50 20 0 10 60 20 0", "without its arrow"),
    ("LINE 67 1 10 50 20 0 11 60 21 0", "paper space"),
    ("LINE 6 DASHDOT 10 50 20 0 11 60 21 0", "line type DASHDOT"),
    ("TEXT 7 none 40 3 10 50 20 0 1 H", "text in txt"),
];

#[test]
fn each_unsupported_entity_type_yields_a_note_that_names_it() {
    let entities: String = UNSUPPORTED
        .iter()
        .map(|kind| format!("0 {kind} 5 AB 8 ribs "))
        .collect();
    for (kind, entity) in UNSUPPORTED.iter().zip(entities.split_inclusive("ribs ")) {
        // The types SECTION and TABLE are structural elsewhere; in a block they are entities.
        if *kind == "SECTION" || *kind == "TABLE" {
            continue;
        }
        let found = found(&format!("{SQUARE} {entity}")).expect(kind);
        let words = words(&found);
        assert_eq!(words.len(), 1, "{words:?}");
        let start = format!("1 {kind} left out: ");
        assert!(words[0].starts_with(&start), "{words:?}");
        assert!(words[0].ends_with("layer ribs, handle AB)"), "{words:?}");
    }
}

/// Entity types of the DXF Reference (release 2018), under the names that files use; without those
/// that are structural elsewhere (SECTION, TABLE) or belong to other entities (SEQEND, VERTEX), and
/// without VIEWPORT, which has no content.
const REFERENCE: [&str; 46] = [
    "3DFACE",
    "3DSOLID",
    "ACAD_PROXY_ENTITY",
    "ACAD_TABLE",
    "ARC",
    "ATTDEF",
    "ATTRIB",
    "BODY",
    "CIRCLE",
    "DGNUNDERLAY",
    "DIMENSION",
    "DWFUNDERLAY",
    "ELLIPSE",
    "EXTRUDEDSURFACE",
    "HATCH",
    "HELIX",
    "IMAGE",
    "INSERT",
    "LEADER",
    "LIGHT",
    "LINE",
    "LOFTEDSURFACE",
    "LWPOLYLINE",
    "MESH",
    "MLINE",
    "MTEXT",
    "MULTILEADER",
    "OLE2FRAME",
    "OLEFRAME",
    "PDFUNDERLAY",
    "POINT",
    "POLYLINE",
    "RAY",
    "REGION",
    "REVOLVEDSURFACE",
    "SHAPE",
    "SOLID",
    "SPLINE",
    "SUN",
    "SURFACE",
    "SWEPTSURFACE",
    "TEXT",
    "TOLERANCE",
    "TRACE",
    "WIPEOUT",
    "XLINE",
];

#[test]
fn each_entity_type_of_the_reference_is_drawn_or_reported() {
    for kind in REFERENCE {
        // An entity without data cannot be drawn, so each type must be reported by name.
        let found = found(&format!("{SQUARE} 0 {kind} 5 AB 8 ribs")).expect(kind);
        let words = words(&found);
        assert_eq!(words.len(), 1, "{kind}: {words:?}");
        let start = format!("1 {kind} left out: ");
        assert!(words[0].starts_with(&start), "{words:?}");
        assert_near(found.regions.area(), 16.0);
    }
}

#[test]
fn each_approximation_yields_a_note_that_names_the_feature() {
    for (entity, feature) in APPROXIMATED {
        let found = found(&format!("{SQUARE} 0 {entity}")).expect(entity);
        let words = words(&found);
        let kind = entity.split(' ').next().expect("a type");
        let is_reported = words.iter().any(|note| note.contains(feature));
        assert!(is_reported, "{entity}: {words:?}");
        let names_type = words.iter().any(|note| note.contains(kind));
        let is_line_or_text = ["LINE", "TEXT"].contains(&kind);
        assert!(names_type || is_line_or_text, "{entity}: {words:?}");
    }
}

#[test]
fn clipped_block_references_are_reported() {
    let found = found_in(&[
        ("ENTITIES", SQUARE),
        ("OBJECTS", "0 SPATIAL_FILTER 5 C1 70 2 10 0 20 0 10 9 20 9"),
    ]);
    let words = words(&found.expect("a square"));
    assert!(words[0].contains("1 SPATIAL_FILTER ignored"), "{words:?}");
}

#[test]
fn entities_of_blocks_are_reported_where_they_are_drawn() {
    let block = format!(
        "0 BLOCK 2 B {SQUARE} 0 REGION 5 7 8 0 0 ENDBLK 0 BLOCK 2 UNUSED 0 BODY 8 0 0 ENDBLK"
    );
    let entities = "0 INSERT 8 walls 2 B 0 INSERT 8 walls 2 B 10 9";
    let found = found_in(&[("BLOCKS", &block), ("ENTITIES", entities)]).expect("squares");
    let words = words(&found);
    assert_eq!(words.len(), 1, "{words:?}");
    assert!(words[0].starts_with("2 REGION left out"), "{words:?}");
    assert!(words[0].contains("the first in line") && words[0].contains("layer walls, handle 7"));
}

#[test]
fn a_hostile_file_has_a_limited_number_of_notes() {
    let entities: String = (0..500).map(|k| format!("0 KIND{k} 8 0 ")).collect();
    let found = found(&format!("{SQUARE} {entities}")).expect("a square");
    let words = words(&found);
    assert!(words.len() <= 51, "{}", words.len());
    assert!(
        words
            .iter()
            .any(|note| note.starts_with("450 other entities left out")),
        "{words:?}"
    );
}
