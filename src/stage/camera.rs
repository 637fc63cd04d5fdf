//! The camera that shows the part of the plane given by [`StageView`].

use bevy::camera::CompositingSpace;
use bevy::prelude::*;

use super::stage_view::StageView;

/// Marks a camera that shows the part of the plane given by [`StageView`].
///
/// The plugin does not move cameras without this marker, so a program can place its own.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[reflect(Component, Clone, Debug, Default)]
// Semi-transparent colours are blended in sRGB, as in exported files.
#[require(Camera2d, Msaa::Sample4, CompositingSpace::Srgb)]
pub struct StageCamera;

/// Moves and scales all stage cameras according to the view, and copies the size of their viewport
/// into the view.
pub(super) fn apply_view(
    mut view: ResMut<StageView>,
    mut cameras: Query<(&Camera, &mut Transform, &mut Projection), With<StageCamera>>,
) {
    for (camera, transform, mut projection) in &mut cameras {
        if let Some(viewport_px) = camera.logical_viewport_size()
            // A minimised window has no pixels; the view then keeps its last size.
            && viewport_px.min_element() >= 1.0
            && viewport_px != view.viewport_px
        {
            view.viewport_px = viewport_px;
        }
        // The centre of the view is near the point of the plane at Bevy's origin, wherever the
        // design lies, so single precision suffices.
        let at = (view.centre - view.anchor()).as_vec2();
        let translation = at.extend(transform.translation.z);
        let mut place = transform.map_unchanged(|transform| &mut transform.translation);
        place.set_if_neq(translation);
        let scale = view.units_per_px as f32;
        // The scales are compared first, because a mutable borrow marks the projection as changed.
        if matches!(&*projection, Projection::Orthographic(p) if p.scale != scale)
            && let Projection::Orthographic(orthographic) = &mut *projection
        {
            orthographic.scale = scale;
        }
    }
}
