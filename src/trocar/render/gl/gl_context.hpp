// An OpenGL 3.3 core context: our own without a window (EGL; works without a display), or the one a window made.
#pragma once

#include <memory>
#include <string>

namespace trocar::render {

class GlContext {
 public:
  /// A context without window or surface, made current. Mesa's surfaceless platform first, then EGL devices.
  /// @throws core::EnvironmentLacks with what to install if there is neither
  static std::unique_ptr<GlContext> off_screen();
  /// The context that is current now (GLFW made it); is not destroyed with this object.
  /// @throws core::EnvironmentLacks if none is current or it is older than OpenGL 3.3
  static std::unique_ptr<GlContext> adopt_current();

  virtual ~GlContext() = default;
  virtual void make_current() = 0;
  /// The driver was reset and has forgotten everything that it was given. Asks a driver that can tell.
  bool lost() const;
  /// No graphics card does.
  bool draws_on_processors() const { return m_description.find("llvmpipe") != std::string::npos; }
  /// "vendor / renderer / version", for logs and reports.
  const std::string& description() const { return m_description; }

 protected:
  void check_version();  ///< fills the description
  std::string m_description;
};

}  // namespace trocar::render
