//! Pictures of the stage at any size, on a coloured or a transparent ground,
//! drawn off screen by a camera of their own.
//!
//! Guarantees: each [`CaptureStage`] is answered by exactly one
//! [`StageCaptured`], with the picture or with words for a user; colours are
//! blended as the exporters blend them; panels and other windows are not in
//! the picture. Does not guarantee the very frame of the request: the graphics
//! card may have to prepare itself first, and the answer says at which t the
//! picture was taken.

use bevy::camera::{CompositingSpace, RenderTarget};
use bevy::prelude::*;
use bevy::render::render_resource::TextureFormat;
use bevy::render::renderer::RenderDevice;
use bevy::render::view::screenshot::{Screenshot, ScreenshotCaptured};
use image::RgbaImage;

use crate::colour::Rgb;
use crate::export::make_straight;
use crate::geometry::Bounds;

use super::components::Blend;
use super::pipelines::PipelinesReady;
use super::stage_view::{StageView, units_per_px};

/// Frames to wait for the graphics card before a capture is given up: twenty
/// seconds at 60 a second. Longer and a user waits for nothing, shorter and a
/// slow machine that compiles its shaders has no picture.
const PATIENCE: u32 = 1200;

/// Asks for a picture of the stage.
#[derive(Message, Clone, Debug)]
pub struct CaptureStage {
    /// Comes back in the answer.
    pub id: u64,
    /// Width and height in pixels.
    pub size_px: UVec2,
    /// The colour behind everything; `None` is transparent.
    pub ground: Option<Rgb>,
    /// The part of the plane to show: all of it is visible, centred.
    pub view: Bounds,
}

/// The answer to a [`CaptureStage`].
#[derive(Message, Clone, Debug)]
pub struct StageCaptured {
    /// The request's.
    pub id: u64,
    /// The blend parameter in the picture, if anything was on the stage.
    pub t: Option<f64>,
    /// The picture with straight (not premultiplied) alpha, upper row first,
    /// or why there is none.
    pub result: Result<RgbaImage, String>,
}

/// Captures that are under way.
#[derive(Resource, Default)]
pub(super) struct PendingCaptures(Vec<CaptureTarget>);

struct CaptureTarget {
    id: u64,
    camera: Entity,
    image: Handle<Image>,
    shot: Option<Entity>,
    t: Option<f64>,
    frames: u32,
}

/// What a picture is made with; all of it is missing without a renderer.
type RenderAccess<'w> = (
    Option<ResMut<'w, Assets<Image>>>,
    Option<Res<'w, RenderDevice>>,
    Option<Res<'w, PipelinesReady>>,
);

/// Sets up a camera for each request.
pub(super) fn begin_captures(
    mut commands: Commands,
    mut requests: MessageReader<CaptureStage>,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
    graphics: RenderAccess,
    view: Res<StageView>,
) {
    let (Some(mut images), Some(device), Some(ready)) = graphics else {
        for request in requests.read() {
            answers.write(refused(
                request.id,
                "there is no graphics card to draw it with",
            ));
        }
        return;
    };
    let largest = device.limits().max_texture_dimension_2d;
    for request in requests.read() {
        let size = request.size_px;
        if size.min_element() == 0 || size.max_element() > largest {
            let why = format!(
                "the graphics card draws pictures of 1 to {largest} pixels a side, \
                 not {} × {}; choose another size",
                size.x, size.y
            );
            answers.write(refused(request.id, &why));
            continue;
        }
        let format = TextureFormat::Rgba8UnormSrgb;
        let image = images.add(Image::new_target_texture(size.x, size.y, format, None));
        let camera = commands.spawn(camera(request, &image, view.anchor())).id();
        // Other pipelines than the window's may be wanted: its format is
        // another.
        ready.start_over();
        captures.0.push(CaptureTarget {
            id: request.id,
            camera,
            image,
            shot: None,
            t: None,
            frames: 0,
        });
    }
}

fn refused(id: u64, why: &str) -> StageCaptured {
    StageCaptured {
        id,
        t: None,
        result: Err(format!("no picture was taken: {why}")),
    }
}

fn camera(request: &CaptureStage, image: &Handle<Image>, anchor: glam::DVec2) -> impl Bundle {
    let at = (request.view.centre() - anchor).as_vec2();
    let ground = request
        .ground
        .map_or(Color::NONE, |Rgb([r, g, b])| Color::srgb_u8(r, g, b));
    let scale = units_per_px(request.view, request.size_px.as_vec2()) as f32;
    (
        Camera2d,
        Camera {
            order: -1,
            clear_color: ClearColorConfig::Custom(ground),
            ..default()
        },
        Projection::Orthographic(OrthographicProjection {
            scale,
            ..OrthographicProjection::default_2d()
        }),
        Transform::from_translation(at.extend(0.0)),
        RenderTarget::Image(image.clone().into()),
        Msaa::Sample4,
        CompositingSpace::Srgb,
    )
}

/// Takes the picture once the graphics card is ready, and gives up in the end.
pub(super) fn advance_captures(
    mut commands: Commands,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
    ready: Option<Res<PipelinesReady>>,
    blends: Query<&Blend>,
) {
    let is_ready = ready.is_some_and(|ready| ready.is_ready());
    captures.0.retain_mut(|capture| {
        capture.frames += 1;
        if is_ready && capture.shot.is_none() {
            // Of several entities the first one's: an answer tells one t.
            capture.t = blends.iter().next().map(|blend| blend.t);
            let shot = Screenshot::image(capture.image.clone());
            capture.shot = Some(commands.spawn(shot).observe(finish_capture).id());
        }
        if capture.frames <= PATIENCE {
            return true;
        }
        // Or it would draw into its picture on every frame to come.
        commands.entity(capture.camera).try_despawn();
        if let Some(shot) = capture.shot {
            commands.entity(shot).try_despawn();
        }
        answers.write(refused(capture.id, "the graphics card did not answer"));
        false
    });
}

fn finish_capture(
    shot: On<ScreenshotCaptured>,
    mut commands: Commands,
    mut answers: MessageWriter<StageCaptured>,
    mut captures: ResMut<PendingCaptures>,
) {
    let is_it = |capture: &CaptureTarget| capture.shot == Some(shot.entity);
    // It was given up in the meantime, and has its answer.
    let Some(index) = captures.0.iter().position(is_it) else {
        return;
    };
    let capture = captures.0.swap_remove(index);
    commands.entity(capture.camera).try_despawn();
    let UVec2 { x, y } = shot.image.size();
    let data = shot.image.data.clone().unwrap_or_default();
    let picture = RgbaImage::from_raw(x, y, data);
    answers.write(match picture {
        Some(mut picture) => {
            // Blending over nothing leaves colours multiplied by their alpha, in
            // sRGB values, as that is the space the camera composites in.
            picture.pixels_mut().for_each(make_straight);
            StageCaptured {
                id: capture.id,
                t: capture.t,
                result: Ok(picture),
            }
        }
        None => refused(capture.id, "the graphics card gave back too few pixels"),
    });
}
