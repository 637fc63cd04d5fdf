//! Tests of the default placement of designs with pages.

use super::*;

/// A square on a page of this size that fills the middle of the page.
fn page(size: [f64; 2]) -> Arc<Design> {
    let [width, height] = size;
    let side = 0.5 * width.min(height);
    let (x, y) = (0.5 * (width - side), 0.5 * (height - side));
    design(&format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {height}'>\
         <path d='M{x} {y}h{side}v{side}h-{side}z'/></svg>"
    ))
}

#[test]
fn pages_that_differ_by_more_than_four_times_are_fitted_and_reported() {
    let (first, still) = (page([24.0, 24.0]), Similarity::IDENTITY);
    let bounds = |design: &Design| design.outline(0.0).unwrap().bounds();
    for (size, width) in [
        ([512.0, 512.0], 12.0),
        ([1024.0, 512.0], 6.0),
        ([3.0, 3.0], 12.0),
        ([96.0, 96.0], 48.0),
        ([6.0, 6.0], 3.0),
    ] {
        let other = page(size);
        let placed = place_in_frame(&other, &first, DesignFit::Auto, still).unwrap();
        assert!((bounds(&placed).size().x - width).abs() < 1e-6, "{size:?}");
        let fitted = DesignFit::Auto.fitted_page(&other, &first);
        let is_fitted = !Arc::ptr_eq(&placed, &other);
        assert_eq!(fitted.is_some(), is_fitted);
        assert_eq!(is_fitted, size[0] > 96.0 || size[0] < 6.0);
        if is_fitted {
            let centre = bounds(&placed).centre();
            assert!(centre.distance(DVec2::splat(12.0)) < 1e-6);
            assert!(fitted.unwrap().to_string().contains("fit = as-drawn"));
        }
        let drawn = place_in_frame(&other, &first, DesignFit::AsDrawn, still).unwrap();
        assert!(Arc::ptr_eq(&drawn, &other));
        assert!(!DesignFit::AsDrawn.depends_on_first(&[first.clone(), other.clone()]));
        assert_eq!(
            DesignFit::Auto.depends_on_first(&[first.clone(), other]),
            is_fitted
        );
    }
    // Coordinates in a file without a page are meant as they are.
    let plan = design("[[0,0],[400,0],[400,300]]");
    let placed = place_in_frame(&plan, &first, DesignFit::Auto, still).unwrap();
    assert!(Arc::ptr_eq(&placed, &plan));
}
