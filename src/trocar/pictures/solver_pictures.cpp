#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/attempt/free_way.hpp>
#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/pictures/solver_pictures.hpp>

namespace trocar::pictures {
namespace {

constexpr double kTilts[] = {0.9, 0.6};  // of the view from the surface's normal [rad]; those before are nicer
constexpr double kAway = 2.0;            // of the eye, in sizes of the organ
constexpr double kFov = 0.7;             // [rad]
constexpr int kDirections = 12;          // that are tried
constexpr double kRay = 0.3;  // in sizes of the organ: nearer to the line of sight than this, something hides it

/// A round number that is not below: a scale's end [m].
double round_up(double metres) {
  double unit = 1e-5;
  for (;; unit *= 10)
    for (const double k : {1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 7.5})
      if (k * unit >= metres) return k * unit;
}

/// The eye that sees the place best.
view::ViewOptions camera_at(const sim::Model& model, int organ, Vec3d place, Vec3d out) {
  const std::vector<attempt::DrawnPoint> others = attempt::drawn_points_but(model, organ);
  const Vec3d side = any_perpendicular(out), other = cross(out, side);
  const double away = kAway * attempt::organ_size(model, organ);
  const double ray = kRay * attempt::organ_size(model, organ);
  view::ViewOptions options;
  int fewest = -1;
  for (const double tilt : kTilts)
    for (int k = 0; k < kDirections; ++k) {
      const double turn = 2 * portable::pi * k / kDirections;
      const Vec3d way = std::cos(tilt) * out + std::sin(tilt) * (std::cos(turn) * side + std::sin(turn) * other);
      const int near = attempt::points_near(others, place + ray * out, place + away * way, ray);
      if (fewest >= 0 && near >= fewest) continue;
      fewest = near;
      options.eye = place + away * way;
    }
  options.camera = view::ViewOptions::Camera::outside;
  options.target = place;
  options.up = out;
  options.outside_fov = kFov;
  options.walls = false;
  return options;
}

std::shared_ptr<const view::OrganBeside> beside_of(const sim::Model& model, const sim::State& state, int organ) {
  auto beside = std::make_shared<view::OrganBeside>();
  beside->organ = organ;
  beside->skin = attempt::OrganSkin(model, organ).at(state);
  beside->outline = attempt::OrganSkin(model, organ, attempt::OrganSkin::Which::touched).at(state);
  return beside;
}

}  // namespace

std::vector<SolverPicture> draw_solvers(const attempt::SolverPair& pair, const attempt::SolverComparison& comparison,
                                        const std::filesystem::path& folder, PictureSize size) {
  if (comparison.samples().empty()) return {};
  const sim::Model& model = pair.dynamic->model;
  const attempt::SolverSample worst = comparison.summary().worst;
  const tissue::Skin& skin = attempt::OrganSkin(model, pair.organ).skin();
  const Vec3d place = vec_cast<double>(skin.rest[std::size_t(worst.vertex)]);
  view::ViewOptions look =
      camera_at(model, pair.organ, place, vec_cast<double>(skin.rest_normal[std::size_t(worst.vertex)]));
  Pictures pictures(model, size);
  std::vector<SolverPicture> drawn;
  const auto add = [&](const char* file, std::string text) {
    render::write_png((folder / file).string(), pictures.still(comparison.dynamic_state(), look));
    drawn.push_back({file, std::move(text)});
  };
  add("plain.png", tr("as the dynamic solver has it, {:.2f} s", worst.seconds));
  look.beside = beside_of(pair.at_once->model, comparison.static_state(), pair.organ);
  look.analysis.solvers = true;
  look.analysis.apart_most = round_up(worst.largest);
  add("apart.png",
      tr("the same in colours of the distance, up to {:.2f} mm, with the static one's outline", 1e3 * worst.largest));
  return drawn;
}

}  // namespace trocar::pictures
