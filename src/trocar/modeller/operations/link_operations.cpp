// What lies between bodies: folds from a cord to an organ, bonds between a pouch and what it faces.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/body_mesh.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/places.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

/// So many points along a line of straight pieces, by arc length [mm].
std::vector<Vec3d> along(const std::vector<Vec3d>& line, double from, double to, int count) {
  std::vector<double> way{0};
  for (std::size_t i = 1; i < line.size(); ++i) way.push_back(way.back() + length(line[i] - line[i - 1]));
  std::vector<Vec3d> out;
  for (int k = 0; k < count; ++k) {
    const double s = std::clamp(from + (to - from) * k / (count - 1), 0.0, way.back());
    std::size_t i = 1;
    while (i + 1 < line.size() && way[i] < s) ++i;
    out.push_back(line[i - 1] + (line[i] - line[i - 1]) * ((s - way[i - 1]) / std::max(way[i] - way[i - 1], 1e-9)));
  }
  return out;
}

Operation fold() {
  return {{"fold",
           "A membrane from a stretch of a strand to an organ: its base lies on the organ's surface, nearest to the "
           "strand.",
           {scene::needed(keys::name("name", "what it is called")), scene::needed(keys::name("tissue", "its material")),
            scene::needed(keys::text("strand", "along one border")),
            scene::needed(keys::text("onto", "the solid or pouch that carries its base")),
            scene::needed(keys::number("from_mm", 0, 5000, "arc length on the strand where it begins")),
            scene::needed(keys::number("to_mm", 0, 5000, "and where it ends")),
            keys::number("thickness_mm", 0.05, 20, "default 0.5"),
            keys::integer("points", 2, 100, "of its base, default 8")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing strand = draft.thing("strand:" + o.text("strand")), body = draft.thing(o.text("onto"));
            const geometry::TriMesh mesh = body_mesh(draft.document(), body);
            if (mesh.triangles.empty())
              return o.fault("onto", "expected a solid or a pouch with a shape, got something else");
            const JsonValue value = draft.value(strand.file, strand.path);
            const scene::JsonMember* line = value.find("centreline_mm");
            if (!line || points_of(line->value).size() < 2)
              return o.fault("strand", "expected a strand with a centre line");
            if (!(o.number("to_mm") > o.number("from_mm"))) return o.fault("to_mm", "expected more than from_mm");
            std::vector<Vec3d> base;
            for (const Vec3d& p :
                 along(points_of(line->value), o.number("from_mm"), o.number("to_mm"), o.integer("points", 8)))
              base.push_back(nearest_foot(mesh, p).at);
            JsonValue membrane = scene::json_object();
            scene::put(membrane, "name", scene::json_text(o.text("name")));
            scene::put(membrane, "tissue", scene::json_text(o.text("tissue")));
            scene::put(membrane, "strand", scene::json_text(strand.name));
            scene::put(membrane, "from_mm", number(o.number("from_mm")));
            scene::put(membrane, "to_mm", number(o.number("to_mm")));
            scene::put(membrane, "base_mm", points(base));
            scene::put(membrane, "base_on", scene::json_array({scene::json_text(body.name)}));
            scene::put(membrane, "thickness_mm", number(o.number("thickness_mm", 0.5)));
            add_thing(draft, "membrane", membrane, "");
          }};
}

/// Balls that together hold all places, each around a place that no ball before holds.
std::vector<Vec3d> covered_by_balls(const std::vector<Vec3d>& places, double radius) {
  std::vector<Vec3d> middles;
  for (const Vec3d& p : places)
    if (std::none_of(middles.begin(), middles.end(), [&](Vec3d m) { return length(m - p) < radius; }))
      middles.push_back(p);
  return middles;
}

Operation bond() {
  return {
      {"bond_facing",
       "Ties a pouch's wall to an organ where the two face each other: bonds that hold, and part when pulled, pushed "
       "or cut.",
       {scene::needed(keys::text("of", "the pouch")), scene::needed(keys::text("on", "the solid that it is tied to")),
        scene::needed(keys::name("name", "of the bonds")),
        keys::number("within_mm", 0.1, 100, "how near the two are where they are tied, default 5"),
        keys::number("radius_mm", 0.5, 100, "of the balls that say where, default 6"),
        keys::number("toughness_J_m2", 0.1, 100000, "default 50")}},
      [](const JsonObject& o, Draft& draft) {
        const Thing pouch = draft.thing("pouch:" + o.text("of")), body = draft.thing(o.text("on"));
        const geometry::TriMesh wall = body_mesh(draft.document(), pouch), organ = body_mesh(draft.document(), body);
        if (wall.triangles.empty() || organ.triangles.empty())
          return o.fault(wall.triangles.empty() ? "of" : "on", "expected a body with a shape, got something else");
        const double within = o.number("within_mm", 5), radius = o.number("radius_mm", 6);
        std::vector<Vec3d> facing;
        for (const Vec3d& p : wall.positions)
          if (nearest_foot(organ, p).distance <= within) facing.push_back(p);
        if (facing.empty())
          return o.fault("within_mm",
                         tr("expected bodies that come within {:g} mm of each other, got none so near", within));
        std::vector<JsonValue> places;
        for (const Vec3d& middle : covered_by_balls(facing, radius)) {
          JsonValue ball = scene::json_object();
          scene::put(ball, "centre_mm", point(middle));
          scene::put(ball, "radius_mm", number(radius));
          places.push_back(std::move(ball));
        }
        JsonValue bonds = scene::json_object();
        scene::put(bonds, "name", scene::json_text(o.text("name")));
        scene::put(bonds, "places", scene::json_array(std::move(places)));
        scene::put(bonds, "on", scene::json_array({scene::json_text(body.name)}));
        scene::put(bonds, "reach_mm", number(within));
        scene::put(bonds, "toughness_J_m2", number(o.number("toughness_J_m2", 50)));
        const JsonValue there = draft.value(pouch.file, pouch.path + "/bonds");
        if (there.kind == JsonValue::Kind::array)
          draft.insert(pouch.file, pouch.path + "/bonds", there.items.size(), bonds);
        else
          draft.set(pouch.file, pouch.path + "/bonds", scene::json_array({bonds}));
        draft.say(tr("tied where {} of {} places of the wall are within {:g} mm", facing.size(), wall.positions.size(),
                     within));
      }};
}

}  // namespace

std::vector<Operation> link_operations() { return {fold(), bond()}; }

}  // namespace trocar::modeller
