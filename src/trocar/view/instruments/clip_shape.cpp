#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/numerics/portable.hpp>
#include <trocar/view/base/pinch.hpp>
#include <trocar/view/instruments/clip_shape.hpp>

namespace trocar::view {
namespace {

constexpr int kGrooves = 5, kLegSteps = 3 * kGrooves, kBendSteps = 7;
constexpr double kGrooveLeft = 0.76;  // of a leg's thickness, in its grooves
constexpr double kChamfer = 0.00023;  // [m] its edges are bevelled
constexpr double kClipTip = 0.00022;  // [m] and so are its tips
constexpr double kSpread = 0.0042;    // [m] an open one is a chevron down to here, from there its legs are parallel
constexpr double kBendWider = 0.12;   // share by which the wire is flattened where it was bent
constexpr double kAskew = 0.00011;    // [m] tips that met never lie quite on each other
// Bevels are bright beside what is between them; little light comes between the legs.
const Paint kClipBevel{255, 0, 0, 0}, kOutside{215, 0, 0, 0}, kInside{60, 0, 0, 40};

/// A place on the middle line of the wire, and the share of the full section it has there.
struct WirePlace {
  Vec3d at;
  double share = 1;
};

/// From the tip of one leg round the bend to the tip of the other.
std::vector<WirePlace> wire(double leg, double gap) {
  const double bow = kClipHalfGap + 0.5 * kClipLegThickness, eye = 1.6 * bow, open = smooth(0, kSpread, gap);
  const auto spread = [&](double z) { return 0.5 * gap * std::sin(0.5 * portable::pi * std::min(1.0, z / kSpread)); };
  const auto askew = [&](double z) { return kAskew * (1 - open) * z / leg; };
  std::vector<WirePlace> half;
  const auto on_leg = [&](double z, double share) { half.push_back({{bow + spread(z), askew(z), z}, share}); };
  on_leg(leg, 0.62);
  on_leg(leg - kClipTip, 1);
  for (int i = 1; i < kLegSteps; ++i) on_leg(eye + (leg - eye) * (1 - double(i) / kLegSteps), 1);
  for (int i = 0; i <= kBendSteps; ++i) {  // it does not close flat: an eye is left, wider than the legs are apart
    const double a = 0.5 * portable::pi * i / kBendSteps, z = eye * (1 - std::sin(a));
    const double eye_wide = bow * std::cos(a) * (1 + 0.22 * std::sin(2 * a) * (1 - open));
    half.push_back({{eye_wide * (1 - 0.3 * open * std::sin(a)) + spread(z), askew(z), z}, 1});
  }
  std::vector<WirePlace> line = half;
  for (std::size_t i = half.size() - 1; i-- > 0;)
    line.push_back({{-half[i].at.x, -half[i].at.y, half[i].at.z}, half[i].share});
  return line;
}

/// Legs are grooved across on their inner sides, so that tissue does not slip out between them.
bool in_groove(std::size_t i, std::size_t count) {
  const std::size_t from_tip = std::min(i, count - 1 - i);
  return from_tip > 1 && from_tip < std::size_t(kLegSteps) && from_tip % 3 == 0;
}

constexpr std::uint32_t kCorners = 9, kDomed = 3;  // of the section; the first of them lie on its domed outside

/// Corners of the section, once around, in half extents: (inwards, across). Edges are bevelled, and the outside is
/// domed, so that it shows the lamp as a line.
std::array<Vec3d, kCorners> corners(double thick, double wide) {
  constexpr double kDome = 0.5;
  const double x = 1 - 2 * kChamfer / thick, y = 1 - 2 * kChamfer / wide;
  return {{{-1 + kDome, y, 0},
           {-1, 0, 0},
           {-1 + kDome, -y, 0},
           {kDome - x, -1, 0},
           {x, -1, 0},
           {1, -y, 0},
           {1, y, 0},
           {x, 1, 0},
           {kDome - x, 1, 0}}};
}

/// Every corner twice: edges are hard, each face has its own normals; but a domed face is one.
void join_faces(MeshBuffer& b, std::uint32_t low, std::uint32_t high) {
  for (std::uint32_t i = 0; i < kCorners; ++i) {
    const std::uint32_t from = 2 * i + 1, to = (i + 1 < kDomed - 1 ? 2 * i + 3 : 2 * i + 2) % (2 * kCorners);
    b.quad(low + from, low + to, high + to, high + from);
  }
}

}  // namespace

MeshBuffer clip_shape(double leg_length, double gap) {
  const std::vector<WirePlace> line = wire(leg_length, gap);
  const std::array<Vec3d, kCorners> shape = corners(kClipLegThickness, kClipLegWidth);
  const Vec3d y{0, 1, 0};
  MeshBuffer b;
  const auto add_row = [&](std::size_t i, bool twice) {
    const auto at = [&](std::size_t k) { return line[k].at; };
    const Vec3d way = at(std::min(i + 1, line.size() - 1)) - at(i > 0 ? i - 1 : 0);
    const Vec3d along = normalised(Vec3d{way.x, 0, way.z});
    const Vec3d inwards = cross(y, along);  // the wire runs up one leg and down the other
    const double half = 0.5 * kClipLegThickness * line[i].share;
    const double left = in_groove(i, line.size()) ? kGrooveLeft : 1;
    const double bent = smooth(0.0016, 0, at(i).z);
    const double wide = 0.5 * kClipLegWidth * line[i].share * (1 + kBendWider * bent);
    const std::uint32_t row = b.size();
    for (std::size_t c = 0; c < shape.size(); ++c) {
      const Vec3d q = shape[c];
      const double in = q.x > 0 ? (2 * left - 1) * q.x : q.x;
      const Vec3f p = vec_cast<float>(at(i) + (half * in) * inwards + (wide * q.y) * y);
      for (int k = 0; k < (twice ? 2 : 1); ++k)
        b.add(p, q.x > 0.5 ? kInside : c >= kDomed || (c != 1 && k == int(c / 2)) ? kClipBevel : kOutside);
    }
    return row;
  };
  std::uint32_t before = 0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const std::uint32_t row = add_row(i, true);
    if (i > 0) join_faces(b, before, row);
    before = row;
  }
  for (const std::size_t end : {std::size_t(0), line.size() - 1}) {
    const std::uint32_t row = add_row(end, false);
    join_pole(b, row, kCorners, b.add(vec_cast<float>(line[end].at), kOutside), end > 0);
  }
  return b;
}

}  // namespace trocar::view
