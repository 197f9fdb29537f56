#include <cstring>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <trocar/core/error.hpp>
#include <trocar/render/gl/gl_context.hpp>
#include <trocar/render/gl/gl_driver_guard.hpp>

namespace trocar::render {

namespace {

const char* const kRemedy =
    "no OpenGL 3.3 without a display on this machine: install Mesa's EGL and software driver "
    "(apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri), or use --headless without --shots";

bool has_client_extension(const char* name) {
  const char* list = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  return list && std::strstr(list, name);
}

EGLDisplay initialised(EGLDisplay display) {
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr)) return display;
  return EGL_NO_DISPLAY;
}

EGLDisplay surfaceless_display() {
  if (!has_client_extension("EGL_MESA_platform_surfaceless")) return EGL_NO_DISPLAY;
  return initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr));
}

EGLDisplay device_display() {
  if (!has_client_extension("EGL_EXT_platform_device") || !has_client_extension("EGL_EXT_device_enumeration"))
    return EGL_NO_DISPLAY;
  EGLDeviceEXT devices[16];
  EGLint count = 0;
  if (!eglQueryDevicesEXT(16, devices, &count)) return EGL_NO_DISPLAY;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay display = initialised(eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr));
    if (display != EGL_NO_DISPLAY) return display;
  }
  return EGL_NO_DISPLAY;
}

EGLContext core_context(EGLDisplay display) {
  if (!eglBindAPI(EGL_OPENGL_API)) return EGL_NO_CONTEXT;
  const EGLint config_wish[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display, config_wish, &config, 1, &count) || count == 0) return EGL_NO_CONTEXT;
  // One that reports a reset, where the driver knows how.
  EGLint wish[] = {EGL_CONTEXT_MAJOR_VERSION,
                   3,
                   EGL_CONTEXT_MINOR_VERSION,
                   3,
                   EGL_CONTEXT_OPENGL_PROFILE_MASK,
                   EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                   EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                   EGL_LOSE_CONTEXT_ON_RESET,
                   EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, wish);
  if (context != EGL_NO_CONTEXT) return context;
  wish[6] = EGL_NONE;
  return eglCreateContext(display, config, EGL_NO_CONTEXT, wish);
}

class OffScreenContext final : public GlContext {
 public:
  OffScreenContext() {
    for (EGLDisplay (*open)() : {surfaceless_display, device_display}) {
      m_display = open();
      if (m_display == EGL_NO_DISPLAY) continue;
      m_context = core_context(m_display);
      if (m_context != EGL_NO_CONTEXT && eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context)) break;
      close();
    }
    if (m_context == EGL_NO_CONTEXT) throw core::EnvironmentLacks(kRemedy);
    check_version();
  }
  ~OffScreenContext() override { close(); }
  OffScreenContext(const OffScreenContext&) = delete;
  OffScreenContext& operator=(const OffScreenContext&) = delete;

  void make_current() override { eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, m_context); }

 private:
  // The display is shared by the whole process (EGL hands out one per platform), so it is not terminated.
  void close() {
    if (m_context != EGL_NO_CONTEXT) {
      eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      eglDestroyContext(m_display, m_context);
    }
    m_context = EGL_NO_CONTEXT;
  }

  EGLDisplay m_display = EGL_NO_DISPLAY;
  EGLContext m_context = EGL_NO_CONTEXT;
};

/// Asks GLX without needing X's headers: only if its library is loaded can one of its contexts be current.
bool glx_context_is_current() {
  for (const char* name : {"libGLX.so.0", "libGL.so.1"}) {
    void* library = dlopen(name, RTLD_LAZY | RTLD_NOLOAD);
    if (!library) continue;
    const auto current = reinterpret_cast<void* (*)()>(dlsym(library, "glXGetCurrentContext"));
    const bool found = current && current();
    dlclose(library);
    if (found) return true;
  }
  return false;
}

class AdoptedContext final : public GlContext {
 public:
  AdoptedContext() {
    if (eglGetCurrentContext() == EGL_NO_CONTEXT && !glx_context_is_current())
      throw core::EnvironmentLacks("no OpenGL context is current; the window has to make its own current first");
    check_version();
  }
  void make_current() override {}  // the window's owner does that
};

std::string gl_string(GLenum name) {
  const auto* text = reinterpret_cast<const char*>(glGetString(name));
  return text ? text : "?";
}

}  // namespace

void GlContext::check_version() {
  link_driver_guard();
  GLint major = 0, minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  m_description = gl_string(GL_VENDOR) + " / " + gl_string(GL_RENDERER) + " / " + gl_string(GL_VERSION);
  if (10 * major + minor < 33)
    throw core::EnvironmentLacks("OpenGL 3.3 is needed, this is " + m_description +
                                 "; update the graphics driver or set LIBGL_ALWAYS_SOFTWARE=1");
}

bool GlContext::lost() const {
  if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_ARB_robustness")) return false;
  return (epoxy_gl_version() < 45 ? glGetGraphicsResetStatusARB() : glGetGraphicsResetStatus()) != GL_NO_ERROR;
}

std::unique_ptr<GlContext> GlContext::off_screen() { return std::make_unique<OffScreenContext>(); }

std::unique_ptr<GlContext> GlContext::adopt_current() { return std::make_unique<AdoptedContext>(); }

}  // namespace trocar::render
