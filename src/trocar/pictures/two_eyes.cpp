#include <cstdio>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/pictures/two_eyes.hpp>

namespace trocar::pictures {

using render::Eye;

TwoEyes parse_stereo(const std::string& text) {
  const std::string name = text.substr(0, text.find(':'));
  TwoEyes eyes;
  double base = 1e3 * double(eyes.eyes.base), convergence = 1e3 * double(eyes.eyes.convergence);
  char rest = 0;
  bool good = true;
  if (name.size() < text.size())
    good = std::sscanf(text.c_str() + name.size(), ":%lf,%lf%c", &base, &convergence, &rest) == 2;
  good = good && base >= kLeastBase && base <= kMostBase && convergence >= kLeastConvergence &&
         convergence <= kMostConvergence;
  bool known = false;
  std::vector<std::string> names;
  for (const StereoName& s : kStereoNames) {
    if (s.mode == render::StereoMode::quad_buffer) continue;
    names.push_back(s.name);
    if (name == s.name) eyes.mode = s.mode, known = true;
  }
  if (!good || !known)
    throw core::BadInput(
        {{{"--stereo", 0, 0},
          tr("expected one of {}, with :BASE,CONVERGENCE if wanted ({:g} to {:g} mm between "
             "the eyes, {:g} to {:g} mm to what lies on the screen), got '{}'",
             fmt::join(names, ", "), kLeastBase, kMostBase, kLeastConvergence, kMostConvergence, text)}});
  eyes.eyes = {float(1e-3 * base), float(1e-3 * convergence)};
  return eyes;
}

render::StereoPair eyes_of(const TwoEyes& eyes, const render::Frame& frame) {
  render::StereoPair pair = both_eyes(frame, eyes.eyes);
  if (!eyes.swapped) return pair;
  std::swap(pair.left, pair.right);
  std::swap(pair.left.metering, pair.right.metering);  // the first one drawn is metered
  return pair;
}

void draw_for(const TwoEyes& eyes, render::Backend& backend, const render::Frame& frame, const render::Target& target) {
  if (!eyes.on()) return draw_frame(backend, frame, target);
  const render::StereoPair pair = eyes_of(eyes, frame);
  draw_frame(backend, pair.left, target);
  backend.keep_eye(Eye::left, target);
  draw_frame(backend, pair.right, target);
  backend.keep_eye(Eye::right, target);
  backend.combine(*eyes.mode, target);
}

}  // namespace trocar::pictures
