//! The kinds of windows that surfaces are made of.

use raw_window_handle::{RawDisplayHandle, RawWindowHandle, XcbDisplayHandle, XcbWindowHandle};
use std::ffi::{c_void, CStr};
use std::num::NonZeroU32;
use std::ptr::NonNull;

/// What makes surfaces of X11 windows by their xcb handles.
pub(crate) const XCB: &CStr = c"vkCreateXcbSurfaceKHR";

/// The call that makes a surface on a display; none where no driver could lack it.
pub(crate) fn maker(display: RawDisplayHandle) -> Option<&'static CStr> {
    match display {
        RawDisplayHandle::Xlib(_) => Some(c"vkCreateXlibSurfaceKHR"),
        RawDisplayHandle::Xcb(_) => Some(XCB),
        RawDisplayHandle::Wayland(_) => Some(c"vkCreateWaylandSurfaceKHR"),
        _ => None,
    }
}

/// An Xlib window by its xcb handles: all drivers for X11 know these, and SwiftShader no others (given an Xlib surface that the loader made
/// for another driver it crashes). None for other windows, or without the library that knows both.
pub(crate) fn as_xcb(
    display: RawDisplayHandle,
    window: RawWindowHandle,
) -> Option<(RawDisplayHandle, RawWindowHandle)> {
    let (RawDisplayHandle::Xlib(display), RawWindowHandle::Xlib(window)) = (display, window) else { return None };
    let number = NonZeroU32::new(u32::try_from(window.window).ok()?)?;
    let connection = connection(display.display?)?;
    let display = XcbDisplayHandle::new(Some(connection), display.screen);
    Some((display.into(), XcbWindowHandle::new(number).into()))
}

/// The xcb connection of an Xlib display, which stays the display's own.
fn connection(display: NonNull<c_void>) -> Option<NonNull<c_void>> {
    // SAFETY: the library has no initialisers that could misbehave; Xlib itself is loaded, as there is a display.
    let library = unsafe { libloading::Library::new("libX11-xcb.so.1") }.ok()?;
    // SAFETY: this is the function's type in X11/Xlib-xcb.h.
    let call =
        unsafe { library.get::<unsafe extern "C" fn(*mut c_void) -> *mut c_void>(b"XGetXCBConnection\0") }.ok()?;
    // SAFETY: the display is alive: its window is.
    NonNull::new(unsafe { call(display.as_ptr()) })
}
