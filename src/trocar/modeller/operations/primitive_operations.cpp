// Bodies to begin with: balls, bodies of revolution, lofts along a line, cords.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/materials/materials.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

std::vector<scene::Key> with_body_keys(std::vector<scene::Key> more) {
  std::vector<scene::Key> all{scene::needed(keys::name("name", "what it is called")),
                              scene::needed(keys::name("tissue", "its material")),
                              keys::number("cell_mm", 0.1, 100, "edge of its cells; default: a tenth of its length"),
                              keys::flag("pouch", "a thin wall around something instead; default false"),
                              keys::text("file", "the organ file that it goes into; default: the document")};
  for (scene::Key& key : more) all.push_back(std::move(key));
  return all;
}

void put_look(JsonValue& body, const JsonObject& o) {
  if (const std::string look = material_of_tissue(o.text("tissue")); !look.empty())
    scene::put(body, "look", scene::json_text(look));
}

JsonValue section(Vec3d centre, Vec3d across, Vec3d deep) {
  JsonValue out = scene::json_object();
  scene::put(out, "centre_mm", point(centre));
  scene::put(out, "across_mm", point(across));
  scene::put(out, "deep_mm", point(deep));
  return out;
}

void add_loft(const JsonObject& o, Draft& draft, std::vector<JsonValue> sections, double length) {
  const bool pouch = o.flag("pouch");
  JsonValue body = scene::json_object();
  scene::put(body, "name", scene::json_text(o.text("name")));
  scene::put(body, "tissue", scene::json_text(o.text("tissue")));
  put_look(body, o);
  scene::put(body, "sections", scene::json_array(std::move(sections)));
  const double cell = o.number("cell_mm", std::max(0.5, std::round(length) / 10));
  if (pouch) scene::put(body, "thickness_mm", number(2));
  scene::put(body, pouch ? "spacing_mm" : "cell_mm", number(cell));
  add_thing(draft, pouch ? "pouch" : "solid", body, o.text("file"));
}

/// Two directions across `axis`, of length 1, the first as near to the patient's x as can be.
std::pair<Vec3d, Vec3d> across(Vec3d axis) {
  Vec3d x{1, 0, 0};
  if (std::fabs(dot(x, axis)) > 0.9) x = {0, 1, 0};
  x = x - axis * dot(x, axis);
  x = x / length(x);
  return {x, cross(axis, x)};
}

/// Sections end where half an ellipsoid as deep as the shorter half axis closes them: at h with
/// h + m sqrt(1 - h^2 / c^2) = c, so h = c (c^2 - m^2) / (c^2 + m^2), c being half the length and m the shorter half
/// axis.
Operation ellipsoid() {
  return {{"ellipsoid", "A ball or an ellipsoid, lofted along its longest axis.",
           with_body_keys({scene::needed(keys::vec3("centre_mm", -2000, 2000, "its middle")),
                           scene::needed(keys::vec3("half_mm", 0.1, 1000, "its half axes along x, y and z"))})},
          [](const JsonObject& o, Draft& draft) {
            const Vec3d centre = o.vec3("centre_mm"), half = o.vec3("half_mm");
            if (!o.has("half_mm")) return;
            const double lengths[3] = {half.x, half.y, half.z};
            const int longest = int(std::max_element(lengths, lengths + 3) - lengths);
            const Vec3d axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
            const int first = (longest + 1) % 3, second = (longest + 2) % 3;
            const double c = lengths[longest], m = std::min(lengths[first], lengths[second]);
            const double h = std::max(c * (c * c - m * m) / (c * c + m * m), 0.02 * c);
            std::vector<JsonValue> sections;
            const int count = h > 0.1 * c ? 5 : 2;
            for (int i = 0; i < count; ++i) {
              const double s = h * (2.0 * i / (count - 1) - 1), r = std::sqrt(1 - s * s / (c * c));
              sections.push_back(section(centre + axes[longest] * s, axes[first] * (lengths[first] * r),
                                         axes[second] * (lengths[second] * r)));
            }
            add_loft(o, draft, std::move(sections), 2 * c);
          }};
}

Operation revolved() {
  return {
      {"revolved", "A body of revolution: circles along an axis.",
       with_body_keys({scene::needed(keys::vec3("from_mm", -2000, 2000, "where its axis begins")),
                       scene::needed(keys::vec3("to_mm", -2000, 2000, "where it ends")),
                       scene::needed(keys::any("radii_mm", "at least two radii, evenly from one end to the other"))})},
      [](const JsonObject& o, Draft& draft) {
        const Vec3d from = o.vec3("from_mm"), to = o.vec3("to_mm");
        const JsonValue& radii = o.value().find("radii_mm")->value;
        const double along = length(to - from);
        if (!(along > 0.01)) return o.fault("to_mm", "expected another place than from_mm, got the same");
        if (radii.items.size() < 2) return o.fault("radii_mm", "expected an array of at least two numbers");
        const auto [x, y] = across((to - from) / along);
        std::vector<JsonValue> sections;
        for (std::size_t i = 0; i < radii.items.size(); ++i) {
          const double r = radii.items[i].number;
          if (!(r > 0)) return o.fault(o.at("radii_mm", i), "expected a radius above 0");
          sections.push_back(section(from + (to - from) * (double(i) / double(radii.items.size() - 1)), x * r, y * r));
        }
        add_loft(o, draft, std::move(sections), along);
      }};
}

Operation along_line() {
  return {
      {"loft", "A solid body along a line: a circle at each of its points, the sections turned as little as possible.",
       with_body_keys({scene::needed(keys::points("line_mm", -2000, 2000, 2, "points of its middle line")),
                       scene::needed(keys::any("radii_mm", "a radius, or as many as there are points"))})},
      [](const JsonObject& o, Draft& draft) {
        const std::vector<Vec3d> line = o.points("line_mm");
        const JsonValue& radii = o.value().find("radii_mm")->value;
        const bool one = radii.kind == JsonValue::Kind::number;
        if (!one && radii.items.size() != line.size())
          return o.fault("radii_mm", tr("expected one radius or {}, got {}", line.size(), radii.items.size()));
        double length_all = 0;
        std::vector<JsonValue> sections;
        Vec3d x{0, 0, 0};
        for (std::size_t i = 0; i < line.size(); ++i) {
          const Vec3d way = line[std::min(i + 1, line.size() - 1)] - line[i == 0 ? 0 : i - 1];
          if (!(length(way) > 1e-3)) return o.fault(o.at("line_mm", i), "expected points apart, got the same twice");
          const Vec3d axis = way / length(way);
          if (i > 0) length_all += length(line[i] - line[i - 1]);
          x = i == 0 ? across(axis).first : x - axis * dot(x, axis);
          x = x / length(x);
          const double r = one ? radii.number : radii.items[i].number;
          if (!(r > 0)) return o.fault("radii_mm", "expected radii above 0");
          sections.push_back(section(line[i], x * r, cross(axis, x) * r));
        }
        add_loft(o, draft, std::move(sections), length_all);
      }};
}

Operation cord() {
  return {{"cord",
           "A tube or a cord along a line: a strand.",
           {scene::needed(keys::name("name", "what it is called")), scene::needed(keys::name("tissue", "its material")),
            scene::needed(keys::points("line_mm", -2000, 2000, 2, "points of its middle line, from start to end")),
            scene::needed(keys::number("radius_mm", 0.05, 100, "outer radius")),
            keys::number("lumen_mm", 0, 100, "radius of its lumen, default 0: a solid cord"),
            keys::name("start_on", "the solid that its start hangs on, default: held in space"),
            keys::name("end_on", "the solid that its end hangs on, default: held in space"),
            keys::text("file", "the organ file that it goes into; default: the document")}},
          [](const JsonObject& o, Draft& draft) {
            JsonValue station = scene::json_object();
            scene::put(station, "s_mm", number(0));
            scene::put(station, "radius_mm", number(o.number("radius_mm")));
            if (o.number("lumen_mm") > 0) scene::put(station, "lumen_mm", number(o.number("lumen_mm")));
            const auto end = [&](const char* key) {
              JsonValue e = scene::json_object();
              if (o.has(key))
                scene::put(e, "solid", scene::json_text(o.text(key)));
              else
                scene::put(e, "fixed", scene::json_flag(true));
              return e;
            };
            JsonValue strand = scene::json_object();
            scene::put(strand, "name", scene::json_text(o.text("name")));
            scene::put(strand, "tissue", scene::json_text(o.text("tissue")));
            put_look(strand, o);
            scene::put(strand, "centreline_mm", points(o.points("line_mm")));
            scene::put(strand, "stations", scene::json_array({station}));
            scene::put(strand, "start", end("start_on"));
            scene::put(strand, "end", end("end_on"));
            add_thing(draft, "strand", strand, o.text("file"));
          }};
}

}  // namespace

std::vector<Operation> primitive_operations() { return {ellipsoid(), revolved(), along_line(), cord()}; }

}  // namespace trocar::modeller
