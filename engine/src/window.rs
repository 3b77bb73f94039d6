//! Pictures in a window: its surface, and a canvas that pictures and panels are laid on before they are shown.

use crate::error::Named;
use crate::gpu::{Gpu, Vulkan};
use crate::image::Image;
use crate::instance::Instance;
use crate::surfaces;
use crate::swapchain::{blit, extent, next, Next, Swapchain, Terms, Wish, LABEL};
use crate::target::Format;
use crate::transfer::{full_barrier, whole_image};
use crate::{Buffer, Error, Placement, Result};
use ash::{khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use shaders::ImageRef;
use std::ffi::CStr;
use vk::Handle;

/// A rectangle of pixels laid over a picture.
#[derive(Clone, Copy, Debug)]
pub struct Panel<'a> {
    /// Where its left upper corner lies. What hangs over the window's edge is not shown.
    pub at: [u32; 2],
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// Red, green, blue and alpha, which is not looked at; row by row from the top.
    pub pixels: &'a [[u8; 4]],
}

/// What became of a picture that was to be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shown {
    /// The window shows it.
    Yes,
    /// The window has no pixels: it is minimised.
    NoPixels,
    /// The window system had no image to give in time, as for a window that is out of sight. Try again later.
    Later,
}

/// How often images or the surface are made again for one picture before it is left out.
const ATTEMPTS: u32 = 3;

/// What the layers say when the window changed its size between our question and our images, which nobody can prevent
/// (Vulkan-Docs issue 2660).
const RACES: [&str; 2] =
    ["VUID-VkSwapchainCreateInfoKHR-imageExtent-01274", "VUID-VkSwapchainCreateInfoKHR-pNext-07781"];

/// A window that shows pictures. It keeps what the handles come from, so that they stay valid as long as they are used.
pub struct Window<W> {
    gpu: Gpu,
    surfaces: khr::surface::Instance,
    surface: vk::SurfaceKHR,
    terms: Terms,
    swapchain: Option<Swapchain>,
    canvas: Option<Image>,
    panels: Option<Buffer<[u8; 4]>>,
    source: W,
}

impl<W: HasDisplayHandle + HasWindowHandle> Window<W> {
    /// Prepares a window for pictures. The device must have been opened with [`crate::GpuOptions::windows`].
    ///
    /// # Errors
    /// A device that cannot show pictures in this window.
    pub fn new(gpu: &Gpu, source: W) -> Result<Self> {
        let vulkan = gpu.vulkan()?;
        if !vulkan.windows {
            return Err(refused(vulkan, "it was not opened for windows"));
        }
        let surfaces = khr::surface::Instance::new(&vulkan.instance.entry, &vulkan.instance.raw);
        let surface = create_surface(vulkan, &source)?;
        let terms = Terms::of(vulkan, &surfaces, surface).inspect_err(|_| {
            // SAFETY: just made, and used by nothing.
            unsafe { surfaces.destroy_surface(surface, None) };
        })?;
        Ok(Window { gpu: gpu.clone(), surfaces, surface, terms, swapchain: None, canvas: None, panels: None, source })
    }

    /// The window's width and height in pixels; none while it has no pixels. `wanted` is taken where the window follows its pictures
    /// (Wayland).
    pub fn size(&mut self, wanted: [u32; 2]) -> Result<Option<[u32; 2]>> {
        match self.capabilities() {
            Ok(capabilities) => Ok(extent(&capabilities, wanted)),
            Err(answer) => {
                if next("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", answer)? == Next::Surface {
                    self.make_surface_again()?;
                }
                Ok(None)
            }
        }
    }

    /// Shows a colour image, stretched to the window, with panels over it. Waits until the device is done.
    ///
    /// # Errors
    /// A device that is lost or fails. Windows that change size, are minimised, out of sight or lost are no errors.
    pub fn show(&mut self, picture: &Image, panels: &[Panel<'_>], wanted: [u32; 2]) -> Result<Shown> {
        assert_eq!(picture.format(), Format::Colour, "windows show colours");
        for _ in 0..ATTEMPTS {
            let next = self.try_to_show(picture, panels, wanted)?;
            self.report_messages()?;
            match next {
                None => return Ok(Shown::NoPixels),
                Some(Next::Go) => return Ok(Shown::Yes),
                Some(Next::Skip) => return Ok(Shown::Later),
                Some(Next::Images) => self.drop_images()?,
                Some(Next::Surface) => self.make_surface_again()?,
            }
        }
        Ok(Shown::Later)
    }

    /// What was last laid on the canvas: width, height, and red, green, blue and alpha of each pixel; none before the first picture.
    pub fn read_shown(&self) -> Result<Option<([u32; 2], Vec<u8>)>> {
        self.canvas.as_ref().map(|canvas| Ok((canvas.size(), canvas.read()?))).transpose()
    }

    /// Gives the surface back and makes it anew, as after the window system took it.
    pub fn make_surface_again(&mut self) -> Result<()> {
        self.drop_images()?;
        // SAFETY: its swapchain is gone, so nothing uses it.
        unsafe { self.surfaces.destroy_surface(self.surface, None) };
        // Stays null if the next one cannot be made: destroying that does nothing.
        self.surface = vk::SurfaceKHR::null();
        let vulkan = self.gpu.vulkan()?;
        self.surface = create_surface(vulkan, &self.source)?;
        self.terms = Terms::of(vulkan, &self.surfaces, self.surface)?;
        Ok(())
    }

    /// None: the window has no pixels.
    fn try_to_show(&mut self, picture: &Image, panels: &[Panel<'_>], wanted: [u32; 2]) -> Result<Option<Next>> {
        let capabilities = match self.capabilities() {
            Ok(capabilities) => capabilities,
            Err(answer) => return next("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", answer).map(Some),
        };
        let Some(size) = extent(&capabilities, wanted) else { return Ok(None) };
        if self.swapchain.as_ref().is_some_and(|swapchain| swapchain.size != size) {
            self.drop_images()?;
        }
        if self.swapchain.is_none() {
            if let Err(answer) = self.make_images(size, capabilities)? {
                return next("vkCreateSwapchainKHR", answer).map(Some);
            }
        }
        self.compose(picture, panels, size)?;
        match (&self.swapchain, &self.canvas) {
            (Some(swapchain), Some(canvas)) => {
                swapchain.show(self.gpu.vulkan()?, vk::Image::from_raw(canvas.view().image)).map(Some)
            }
            _ => Ok(Some(Next::Skip)),
        }
    }

    fn make_images(
        &mut self,
        size: [u32; 2],
        capabilities: vk::SurfaceCapabilitiesKHR,
    ) -> Result<std::result::Result<(), vk::Result>> {
        let vulkan = self.gpu.vulkan()?;
        let Terms { format, mode } = self.terms;
        let made = Swapchain::new(vulkan, &Wish { surface: self.surface, format, mode, size, capabilities });
        let changed = self.capabilities().is_ok_and(|now| now.current_extent != capabilities.current_extent);
        if changed {
            vulkan.instance.messages.forget(&RACES);
        }
        Ok(made.map(|swapchain| self.swapchain = Some(swapchain)))
    }

    /// Lays picture and panels on the canvas.
    fn compose(&mut self, picture: &Image, panels: &[Panel<'_>], size: [u32; 2]) -> Result<()> {
        let fitting = self.canvas.take().filter(|canvas| canvas.size() == size);
        let canvas = match fitting {
            Some(canvas) => canvas,
            None => Image::new(&self.gpu, "window.canvas", Format::Colour, size)?,
        };
        let placed: Vec<Placed> = panels.iter().filter_map(|panel| Placed::of(panel, size)).collect();
        let pixels: Vec<[u8; 4]> = placed.iter().flat_map(|placed| placed.pixels.iter().copied()).collect();
        let buffer = self.panel_buffer(&pixels)?;
        let regions = regions(&placed);
        let (from, to): (ImageRef, ImageRef) = (picture.view(), canvas.view());
        let (from, to) = (vk::Image::from_raw(from.image), vk::Image::from_raw(to.image));
        let (region, layout) = ([blit(picture.size(), size)], vk::ImageLayout::GENERAL);
        self.gpu.vulkan()?.run_once(|device, commands| {
            // SAFETY: images are always in the general layout, and alive through the wait; the regions lie in buffer and canvas.
            unsafe {
                device.cmd_blit_image(commands, from, layout, to, layout, &region, vk::Filter::NEAREST);
                if !regions.is_empty() {
                    full_barrier(device, commands);
                    device.cmd_copy_buffer_to_image(commands, buffer, to, layout, &regions);
                }
            }
        })?;
        self.canvas = Some(canvas);
        Ok(())
    }

    fn panel_buffer(&mut self, pixels: &[[u8; 4]]) -> Result<vk::Buffer> {
        let fitting = self.panels.take().filter(|buffer| buffer.len() >= pixels.len());
        let mut buffer = match fitting {
            Some(buffer) => buffer,
            None => Buffer::new(&self.gpu, "window.panels", pixels.len(), Placement::Upload)?,
        };
        buffer.write(pixels)?;
        let raw = vk::Buffer::from_raw(buffer.all().raw);
        self.panels = Some(buffer);
        Ok(raw)
    }
}

impl<W> Window<W> {
    fn capabilities(&self) -> std::result::Result<vk::SurfaceCapabilitiesKHR, vk::Result> {
        let vulkan = self.gpu.vulkan().map_err(|_| vk::Result::ERROR_DEVICE_LOST)?;
        if self.surface == vk::SurfaceKHR::null() {
            return Err(vk::Result::ERROR_SURFACE_LOST_KHR);
        }
        // SAFETY: device and surface are alive.
        unsafe { self.surfaces.get_physical_device_surface_capabilities(vulkan.physical, self.surface) }
    }

    fn drop_images(&mut self) -> Result<()> {
        if let Some(mut swapchain) = self.swapchain.take() {
            swapchain.destroy(self.gpu.vulkan()?);
        }
        Ok(())
    }

    /// A message of the validation layer is an error.
    fn report_messages(&self) -> Result<()> {
        match self.gpu.take_messages().into_iter().next() {
            None => Ok(()),
            Some(message) => Err(Error::Validation { stage: LABEL.to_owned(), text: message.text }),
        }
    }
}

impl<W> Drop for Window<W> {
    fn drop(&mut self) {
        if self.drop_images().is_ok() {
            // SAFETY: its swapchain is gone; the window that it was made of goes after this. Null is ignored.
            unsafe { self.surfaces.destroy_surface(self.surface, None) };
        }
    }
}

fn create_surface(vulkan: &Vulkan, source: &(impl HasDisplayHandle + HasWindowHandle)) -> Result<vk::SurfaceKHR> {
    let gone = |error: raw_window_handle::HandleError| refused(vulkan, &format!("the window has no handle ({error})"));
    let display = source.display_handle().map_err(gone)?.as_raw();
    let window = source.window_handle().map_err(gone)?.as_raw();
    let Instance { entry, raw, .. } = &vulkan.instance;
    // SAFETY: the instance is alive and the name ends with a zero.
    let knows = |call: &CStr| unsafe { entry.get_instance_proc_addr(raw.handle(), call.as_ptr()) }.is_some();
    let (display, window) =
        surfaces::as_xcb(display, window).filter(|_| knows(surfaces::XCB)).unwrap_or((display, window));
    // ash panics where a call is missing.
    if let Some(call) = surfaces::maker(display).filter(|call| !knows(call)) {
        return Err(refused(vulkan, &format!("its driver lacks {}", call.to_string_lossy())));
    }
    // SAFETY: the handles come from `source`, which `Window` keeps for as long as the surface lives.
    unsafe { ash_window::create_surface(entry, raw, display, window, None) }.named("vkCreateSurfaceKHR")
}

fn refused(vulkan: &Vulkan, why: &str) -> Error {
    Error::Window { device: vulkan.info.name.clone(), why: why.to_owned() }
}

/// The part of a panel that lies in the window.
#[derive(Debug, PartialEq)]
struct Placed {
    at: [u32; 2],
    size: [u32; 2],
    pixels: Vec<[u8; 4]>,
}

impl Placed {
    fn of(panel: &Panel<'_>, window: [u32; 2]) -> Option<Self> {
        assert_eq!(panel.pixels.len(), (panel.size[0] * panel.size[1]) as usize, "a panel has all its pixels");
        let size = [0, 1].map(|axis| panel.size[axis].min(window[axis].saturating_sub(panel.at[axis])));
        if size.contains(&0) {
            return None;
        }
        let rows = panel.pixels.chunks_exact(panel.size[0] as usize).take(size[1] as usize);
        let pixels = rows.flat_map(|row| row[..size[0] as usize].iter().copied()).collect();
        Some(Placed { at: panel.at, size, pixels })
    }
}

/// Where each panel lies in the buffer, and on the canvas.
fn regions(placed: &[Placed]) -> Vec<vk::BufferImageCopy> {
    let mut first = 0;
    let one = |placed: &Placed| {
        let [x, y] = placed.at.map(|side| side as i32);
        let region = whole_image(Format::Colour, placed.size)
            .buffer_offset(first as u64 * 4)
            .image_offset(vk::Offset3D { x, y, z: 0 });
        first += placed.pixels.len();
        region
    };
    placed.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panels_are_cut_at_the_edges_of_the_window() {
        let pixels: Vec<[u8; 4]> = (0..6).map(|pixel| [pixel; 4]).collect();
        let panel = |at| Panel { at, size: [3, 2], pixels: &pixels };
        let placed = |at| Placed::of(&panel(at), [10, 10]);
        assert_eq!(placed([7, 8]).unwrap().pixels, pixels);
        let cut = placed([8, 9]).unwrap();
        assert_eq!((cut.size, cut.pixels), ([2, 1], vec![[0; 4], [1; 4]]));
        assert_eq!(placed([10, 0]), None);
        let two = [placed([0, 0]).unwrap(), placed([8, 9]).unwrap()];
        let offsets: Vec<u64> = regions(&two).iter().map(|region| region.buffer_offset).collect();
        assert_eq!(offsets, [0, 24]);
    }
}
