#include <algorithm>
#include <array>
#include <cmath>

#include <trocar/modeller/operations/points.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/modeller/picture/handles.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kLine{107, 191, 242}, kPoint{242, 168, 26}, kRim{20, 22, 26};  // as the window's blue and orange

void dot_pixel(render::Image& image, int x, int y, Colour c) {
  if (x < 0 || y < 0 || x >= image.width || y >= image.height) return;
  std::copy(c.begin(), c.end(), image.rgb.begin() + 3 * (std::ptrdiff_t(y) * image.width + x));
}

void paint_line(render::Image& image, Spot a, Spot b, Colour c) {
  const int steps = int(std::min(4000.0f, std::max({std::fabs(b.x - a.x), std::fabs(b.y - a.y), 1.0f})));
  for (int i = 0; i <= steps; ++i) {
    const float t = float(i) / float(steps);
    dot_pixel(image, int(std::lround(a.x + t * (b.x - a.x))), int(std::lround(a.y + t * (b.y - a.y))), c);
  }
}

void paint_disc(render::Image& image, Spot at, int radius, Colour c) {
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x)
      if (x * x + y * y <= radius * radius) dot_pixel(image, int(at.x) + x, int(at.y) + y, c);
}

}  // namespace

namespace {

/// Rows and columns of a net whose points stand row by row.
void add_net(const std::vector<PlacedPoint>& points, std::size_t columns, std::vector<HandleLine>& lines) {
  const std::size_t rows = columns > 0 ? points.size() / columns : 0;
  const auto at = [&](std::size_t r, std::size_t c) { return points[r * columns + c].at * 1e-3; };
  for (std::size_t r = 0; r < rows; ++r) {
    HandleLine row;
    for (std::size_t c = 0; c < columns; ++c) row.points.push_back(at(r, c));
    lines.push_back(std::move(row));
  }
  for (std::size_t c = 0; c < columns; ++c) {
    HandleLine column;
    for (std::size_t r = 0; r < rows; ++r) column.points.push_back(at(r, c));
    lines.push_back(std::move(column));
  }
}

/// The outline of a section, a super-ellipse; none where its text is none.
void add_ring(const scene::JsonValue& section, std::vector<HandleLine>& lines) {
  const scene::JsonMember *centre = section.find("centre_mm"), *across = section.find("across_mm"),
                          *deep = section.find("deep_mm");
  if (!centre || !across || !deep) return;
  if (!is_point(centre->value) || !is_point(across->value) || !is_point(deep->value)) return;
  const Vec3d c = point_of(centre->value), a = point_of(across->value), d = point_of(deep->value);
  const double power = 2 / std::max(1.0, number_in(section, "squareness", 2));
  const auto bent = [power](double v) { return std::copysign(std::pow(std::fabs(v), power), v); };
  constexpr int kSteps = 48;
  HandleLine ring;
  for (int i = 0; i <= kSteps; ++i) {
    const double angle = 2 * M_PI * i / kSteps;
    ring.points.push_back((c + a * bent(std::cos(angle)) + d * bent(std::sin(angle))) * 1e-3);
  }
  lines.push_back(std::move(ring));
}

}  // namespace

Handles handles_of(const Document& document, const std::string& name) {
  Handles out;
  const Thing thing = thing_named(document, name);
  const scene::JsonValue value = value_of(document, thing);
  for (const PointList& list : point_lists(value)) {
    const std::vector<PlacedPoint> points = points_in(value, list.path);
    const std::vector<scene::JsonValue>& items = scene::json_at(value, list.path)->items;
    HandleLine line;
    for (std::size_t i = 0; i < points.size(); ++i) {
      out.points.push_back({thing.name, list.path, i, points[i].at * 1e-3});
      line.points.push_back(points[i].at * 1e-3);
    }
    if (list.kind == PointList::line || list.kind == PointList::sections) out.lines.push_back(std::move(line));
    if (list.kind == PointList::net && !items.empty()) add_net(points, items[0].items.size(), out.lines);
    if (list.kind == PointList::sections)
      for (const scene::JsonValue& section : items) add_ring(section, out.lines);
  }
  return out;
}

std::optional<Spot> spot_of(const render::Camera& camera, int width, int height, Vec3d place) {
  const Vec3f p = {float(place.x), float(place.y), float(place.z)}, way = p - camera.position;
  const float x = dot(camera.rotation.column(0), way), y = dot(camera.rotation.column(1), way);
  const float z = -dot(camera.rotation.column(2), way);
  if (z < camera.near_plane) return std::nullopt;
  const float scale = float(height) / 2 / std::tan(camera.vertical_fov / 2);
  return Spot{float(width) / 2 + scale * (x / z - camera.shift), float(height) / 2 - scale * y / z};
}

Vec3d ray_through(const render::Camera& camera, int width, int height, Spot spot) {
  const float scale = std::tan(camera.vertical_fov / 2) / (float(height) / 2);
  const float x = (spot.x - float(width) / 2) * scale, y = (float(height) / 2 - spot.y) * scale;
  const Vec3f way = camera.rotation.column(0) * x + camera.rotation.column(1) * y - camera.rotation.column(2);
  const Vec3d out{way.x, way.y, way.z};
  return out / length(out);
}

std::optional<std::size_t> handle_at(const Handles& handles, const render::Camera& camera, int width, int height,
                                     Spot spot, float reach) {
  std::optional<std::size_t> best;
  float nearest = reach;
  for (std::size_t i = 0; i < handles.points.size(); ++i) {
    const std::optional<Spot> at = spot_of(camera, width, height, handles.points[i].at);
    if (!at) continue;
    const float off = std::hypot(at->x - spot.x, at->y - spot.y);
    if (off <= nearest) nearest = off, best = i;
  }
  return best;
}

void paint(const Handles& handles, const render::Camera& camera, render::Image& image) {
  for (const HandleLine& line : handles.lines)
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      const std::optional<Spot> a = spot_of(camera, image.width, image.height, line.points[i]);
      const std::optional<Spot> b = spot_of(camera, image.width, image.height, line.points[i + 1]);
      if (a && b) paint_line(image, *a, *b, kLine);
    }
  for (const Handle& handle : handles.points)
    if (const std::optional<Spot> at = spot_of(camera, image.width, image.height, handle.at)) {
      paint_disc(image, *at, 5, kRim);
      paint_disc(image, *at, 4, kPoint);
    }
}

}  // namespace trocar::modeller
