// Two eyes: where points are in their pictures, and how both come together on one screen.
#include <cmath>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include <trocar/core/error.hpp>
#include <trocar/render/backend/backend.hpp>
#include <trocar/render/gl/gl_context.hpp>

#include "gl_fixture.hpp"
#include "sample_scene.hpp"

namespace trocar::render {
namespace {

constexpr StereoEyes kEyes{.base = 0.004f, .convergence = 0.08f};

/// Where a world point is in a frame's picture, -1 .. 1 from left to right.
double across(const Frame& frame, Vec3f p, float aspect) {
  const Camera& c = frame.camera;
  const Vec3f eye = transform_point(view_matrix(c.rotation, c.position), p);
  const Mat4 m = perspective(c.vertical_fov, aspect, c.near_plane, c.far_plane, c.shift);
  return double(m.m[0] * eye.x + m.m[8] * eye.z) / double(-eye.z);
}

TEST(Stereo, PointsAreApartByBaseTimesTheDifferenceOfInverseDistances) {
  Frame frame;
  frame.camera = look_at({0.01f, -0.02f, 0.03f}, {0.03f, 0.01f, -0.02f}, {0, 0, 1});
  const StereoPair pair = both_eyes(frame, kEyes);
  const double half = std::tan(double(frame.camera.vertical_fov) / 2) * 4 / 3;  // tangent of half the width
  for (const float z : {0.03f, 0.08f, 0.2f}) {
    const Camera& c = frame.camera;
    const Vec3f p = c.position - z * c.rotation.column(2) + (0.2f * z) * c.rotation.column(0);
    const double apart = across(pair.left, p, 4.0f / 3) - across(pair.right, p, 4.0f / 3);
    EXPECT_NEAR(apart, double(kEyes.base) * (1 / double(z) - 1 / double(kEyes.convergence)) / half, 1e-5) << z;
  }
}

TEST(Stereo, TheLampStaysWhereItIsAndOneEyeIsMetered) {
  Frame frame;
  frame.camera = look_at({0, 0, 0.05f}, {0.02f, 0, 0}, {0, 1, 0});
  const StereoPair pair = both_eyes(frame, kEyes);
  const auto lamp = [](const Frame& f) { return f.camera.position + f.camera.rotation * f.light.position; };
  EXPECT_LT(length(lamp(pair.left) - lamp(frame)), 1e-7f);
  EXPECT_LT(length(lamp(pair.right) - lamp(frame)), 1e-7f);
  EXPECT_NEAR(length(pair.right.camera.position - pair.left.camera.position), 0.004f, 1e-7f);
  EXPECT_TRUE(pair.left.metering);
  EXPECT_FALSE(pair.right.metering);
}

TEST(Stereo, OneEyeOrTwoSizesAreRefused) {
  auto backend = make_null_backend();
  const Frame frame;
  const Target screen = Target::off_screen(64, 48);
  EXPECT_THROW(backend->combine(StereoMode::anaglyph, screen), Misuse);
  EXPECT_THROW(backend->keep_eye(Eye::left, screen), Misuse) << "nothing was drawn";
  draw_frame(*backend, frame, screen);
  backend->keep_eye(Eye::left, screen);
  EXPECT_THROW(backend->combine(StereoMode::anaglyph, screen), Misuse);
  draw_frame(*backend, frame, Target::off_screen(32, 48));
  EXPECT_THROW(backend->keep_eye(Eye::right, screen), Misuse) << "that is not what was drawn";
  backend->keep_eye(Eye::right, Target::off_screen(32, 48));
  EXPECT_THROW(backend->combine(StereoMode::anaglyph, screen), Misuse);
  draw_frame(*backend, frame, screen);
  backend->keep_eye(Eye::right, screen);
  EXPECT_THROW(backend->combine(StereoMode::quad_buffer, screen), Misuse) << "no window";
  EXPECT_NO_THROW(backend->combine(StereoMode::anaglyph, screen));
  EXPECT_THROW(backend->combine(StereoMode::anaglyph, screen), Misuse) << "again without new pictures";
}

class StereoPictures : public GlFixture {
 protected:
  void SetUp() override {
    GlFixture::SetUp();
    frame.look = plain_look();
  }
  /// Plain colours. @return what each eye sees
  std::array<Image, 2> draw_eyes(int width, int height) {
    frame.background = {0.8f, 0.05f, 0.02f};
    const Target target = Target::off_screen(width, height);
    draw_frame(*backend, frame, target);
    backend->keep_eye(Eye::left, target);
    const Image left = backend->read_pixels();
    frame.background = {0.02f, 0.1f, 0.7f};
    draw_frame(*backend, frame, target);
    backend->keep_eye(Eye::right, target);
    return {left, backend->read_pixels()};
  }
  Image combined(StereoMode mode, int width, int height) {
    draw_eyes(width, height);
    backend->combine(mode, Target::off_screen(width, height));
    return backend->read_pixels();
  }
  /// Is the pixel the left eye's red, not the right one's blue?
  static bool is_left(const Image& image, int x, int y) { return image.at(x, y)[0] > image.at(x, y)[2]; }
};

TEST_F(StereoPictures, StandBesideEachOtherOverEachOtherOrInTurn) {
  const Image beside = combined(StereoMode::side_by_side, 40, 30);
  const Image over = combined(StereoMode::top_bottom, 40, 30);
  const Image rows = combined(StereoMode::row_interlaced, 40, 31);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      EXPECT_EQ(is_left(beside, x, y), x < 20) << x << " " << y;
      EXPECT_EQ(is_left(over, x, y), y < 15) << x << " " << y;
      EXPECT_EQ(is_left(rows, x, y), y % 2 == 0) << x << " " << y;
    }
  EXPECT_EQ(glGetError(), GLenum(GL_NO_ERROR));
}

TEST_F(StereoPictures, AnAnaglyphIsTheLeastSquaresMixOfBoth) {
  const auto eyes = draw_eyes(16, 16);
  backend->combine(StereoMode::anaglyph, Target::off_screen(16, 16));
  const Image image = backend->read_pixels();
  const auto* l = eyes[0].at(8, 8);
  const auto* r = eyes[1].at(8, 8);
  const double expected[3] = {0.456 * l[0] + 0.500 * l[1] + 0.176 * l[2] - 0.043 * r[0] - 0.088 * r[1] - 0.002 * r[2],
                              -0.040 * l[0] - 0.038 * l[1] - 0.016 * l[2] + 0.378 * r[0] + 0.734 * r[1] - 0.018 * r[2],
                              -0.015 * l[0] - 0.021 * l[1] - 0.005 * l[2] - 0.072 * r[0] - 0.113 * r[1] + 1.226 * r[2]};
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(image.at(8, 8)[c], std::clamp(expected[c], 0.0, 255.0), 2) << c;
}

/// A picture whose middle looks aside is a part of a wider one: instruments' shadows, drops, pool and smoke included.
TEST_F(StereoPictures, ThroughAnOffAxisFrustumAllPassesAgree) {
  constexpr int kWidth = 160, kHeight = 120, kAside = 20;
  frame.camera = look_at({0, 0.02f, 0.09f}, {0, 0, 0}, {0, 1, 0});
  frame.camera.far_plane = 1;
  sample::build(*backend, 0, frame);
  frame.rods = {Rod{{-0.03f, 0.03f, 0.05f}, {0.005f, 0.005f, 0.02f}, 0.0025f}};
  for (int k = 0; k < 5; ++k) {
    Splat s;
    s.from = s.to = {-0.02f + 0.01f * float(k), 0.005f, 0.035f};
    s.radius = s.height = 0.0015f;
    frame.liquid.splats.push_back(s);
  }
  frame.liquid.look.kinds[0].absorbs = {0.8e3f, 28e3f, 24e3f};
  frame.smoke.nx = frame.smoke.ny = frame.smoke.nz = 4;
  frame.smoke.cell = 0.015f;
  frame.smoke.origin = {-0.04f, -0.03f, 0};
  frame.smoke.density.assign(64, 0.0f);
  for (std::size_t k = 20; k < 44; ++k) frame.smoke.density[k] = 4;
  const auto picture = [&](int width) {
    draw_frame(*backend, frame, Target::off_screen(width, kHeight));
    return backend->read_pixels();
  };
  const Image wide = picture(kWidth + 2 * kAside), straight = picture(kWidth);
  frame.camera.shift = 2 * std::tan(frame.camera.vertical_fov / 2) * kAside / kHeight;
  const Image aside = picture(kWidth);
  double off = 0, moved = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      for (int c = 0; c < 3; ++c) {
        off += std::fabs(double(aside.at(x, y)[c]) - wide.at(x + 2 * kAside, y)[c]);
        moved += std::fabs(double(aside.at(x, y)[c]) - straight.at(x, y)[c]);
      }
  off /= 3 * kWidth * kHeight, moved /= 3 * kWidth * kHeight;
  std::printf("    off by %.3f of 255 in the mean; pictures differ by %.1f\n", off, moved);
  EXPECT_GT(moved, 5);
  EXPECT_LT(off, 0.5) << "[of 255] smoke is computed at a fifth of the size";
}

}  // namespace
}  // namespace trocar::render
