//! The camera that shows the stage.

use bevy::camera::CompositingSpace;
use bevy::prelude::*;

use super::stage_view::StageView;

/// Marks a camera that shows what [`StageView`] says.
///
/// A program without it places its own camera as it likes: the plugin then
/// leaves all cameras alone.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
// What is half transparent is mixed as in files: on sRGB values.
#[require(Camera2d, Msaa::Sample4, CompositingSpace::Srgb)]
pub struct StageCamera;

/// Brings stage cameras and the view into line.
pub(super) fn apply_view(
    mut view: ResMut<StageView>,
    mut cameras: Query<(&Camera, &mut Transform, &mut Projection), With<StageCamera>>,
) {
    for (camera, transform, mut projection) in &mut cameras {
        if let Some(viewport_px) = camera.logical_viewport_size()
            // A window that is folded away has no pixels; what it showed stays
            // as it was.
            && viewport_px.min_element() >= 1.0
            && viewport_px != view.viewport_px
        {
            view.viewport_px = viewport_px;
        }
        // The difference of the two is small wherever the design lies, and fits
        // single precision.
        let at = (view.centre - view.anchor()).as_vec2();
        let translation = at.extend(transform.translation.z);
        let mut place = transform.map_unchanged(|transform| &mut transform.translation);
        place.set_if_neq(translation);
        let scale = view.units_per_px as f32;
        // Looked at first: borrowed mutably, it would count as changed.
        if matches!(&*projection, Projection::Orthographic(p) if p.scale != scale)
            && let Projection::Orthographic(orthographic) = &mut *projection
        {
            orthographic.scale = scale;
        }
    }
}
