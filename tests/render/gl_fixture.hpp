// A GL backend on whatever OpenGL this machine has, without a display. A machine without EGL fails: setup installs
// Mesa's software driver.
#pragma once

#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/gl/gl_context.hpp>

namespace trocar::render {

class GlFixture : public testing::Test {
 protected:
  void SetUp() override {
    try {
      context = GlContext::off_screen();
    } catch (const core::EnvironmentLacks& e) {
      FAIL() << e.what();
    }
    backend = make_gl_backend(*context);
  }
  void TearDown() override {
    backend.reset();
    context.reset();
  }

  std::unique_ptr<GlContext> context;
  std::unique_ptr<Backend> backend;
  Frame frame;
};

}  // namespace trocar::render
