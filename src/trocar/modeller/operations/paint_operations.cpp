// What differs from place to place on a body: what holds it, where it is tied, how stiff it is, which way its fibres
// run. A stroke of a brush is a row of balls in the body's text, so that a person can read and move it.
#include <algorithm>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/brush.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

constexpr double kUsualFibreRatio = 1.5;

struct Ball {
  Vec3d centre;
  double radius = 0;
};

Ball ball_of(const JsonValue& item) {
  const scene::JsonMember* centre = item.find("centre_mm");
  return {centre && is_point(centre->value) ? point_of(centre->value) : Vec3d{0, 0, 0},
          number_in(item, "radius_mm", 0)};
}

JsonValue dab(const JsonObject& o, Vec3d at) {
  JsonValue ball = scene::json_object();
  scene::put(ball, "centre_mm", point(at));
  scene::put(ball, "radius_mm", number(o.number("radius_mm")));
  if (o.text("what") == "stiffness") scene::put(ball, "stiffness", number(o.number("stiffness", 2)));
  return ball;
}

/// Balls whose middles the brush comes over go.
int rub_out(const JsonObject& o, Draft& draft, const Thing& thing, const std::string& list) {
  const JsonValue there = draft.value(thing.file, list);
  const std::vector<Vec3d> places = o.points("places_mm");
  const double radius = o.number("radius_mm");
  int gone = 0;
  for (std::size_t i = there.items.size(); i-- > 0;) {
    const Ball ball = ball_of(there.items[i]);
    if (std::none_of(places.begin(), places.end(), [&](Vec3d p) { return length(p - ball.centre) < radius; })) continue;
    draft.remove(thing.file, scene::json_path(list, i));
    ++gone;
  }
  return gone;
}

/// What balls that are there cover already is not painted again. Stiffness is: what comes later counts.
bool covered(const std::vector<Ball>& balls, Vec3d place, double radius) {
  return std::any_of(balls.begin(), balls.end(),
                     [&](const Ball& b) { return length(b.centre - place) < 0.25 * radius && b.radius >= radius; });
}

int dab_on(const JsonObject& o, Draft& draft, const Thing& thing, const std::string& list) {
  const double radius = o.number("radius_mm");
  const JsonValue there = draft.value(thing.file, list);
  std::vector<Ball> balls;
  std::vector<JsonValue> items;
  if (o.text("what") != "stiffness")
    for (const JsonValue& item : there.items) balls.push_back(ball_of(item));
  for (const Vec3d& p : o.points("places_mm")) {
    if (covered(balls, p, radius)) continue;
    balls.push_back({p, radius});
    items.push_back(dab(o, p));
  }
  const int count = int(items.size());
  if (there.kind != JsonValue::Kind::array) {
    if (count > 0) draft.set(thing.file, list, scene::json_array(std::move(items)));
    return count;
  }
  for (std::size_t i = 0; i < items.size(); ++i) draft.insert(thing.file, list, there.items.size() + i, items[i]);
  return count;
}

Operation paint() {
  return {
      {"paint",
       "A stroke of a brush on a solid or a pouch: what holds it, where its bonds are, how stiff it is there.",
       {scene::needed(keys::text("of", "the solid or pouch")),
        scene::needed(keys::choice("what", {"hold", "bonds", "stiffness"}, "what the brush paints")),
        scene::needed(keys::points("places_mm", -2000, 2000, 1, "where the brush has been")),
        scene::needed(keys::number("radius_mm", 0.1, 500, "of the brush")),
        keys::number("stiffness", 0.1, 10, "times the tissue's in the brush's middle, default 2; 1: as the tissue is"),
        keys::text("bonds", "name of the pouch's bonds, default: its first"),
        keys::flag("erase", "what was painted there goes instead; default false")}},
      [](const JsonObject& o, Draft& draft) {
        const Thing thing = draft.thing(o.text("of"));
        const std::string within =
            list_of_brush(draft.value(thing.file, thing.path), thing.kind, o.text("what"), o.text("bonds"));
        const std::string list = thing.path + within;
        if (within.empty() && o.text("what") == "bonds")
          return o.fault("what", "expected a pouch that has bonds (bond_facing makes some), got none");
        if (within.empty()) return o.fault("of", tr("expected a solid or a pouch, got a {}", thing.kind));
        const bool erase = o.flag("erase");
        const int balls = erase ? rub_out(o, draft, thing, list) : dab_on(o, draft, thing, list);
        draft.say(fmt::format("{} {} {}", balls, balls == 1 ? "ball" : "balls", erase ? "taken away" : "painted"));
      }};
}

Operation fibres() {
  return {{"fibres",
           "A stroke along which a solid's fibres run: it is stiffer in that direction. Tissue between strokes follows "
           "the nearest ones.",
           {scene::needed(keys::text("of", "the solid")),
            keys::points("line_mm", -2000, 2000, 2, "the stroke; default: along the solid's own middle line"),
            keys::number("ratio", 0.5, 4, "stiffness along them over across, default: as it is, else 1.5"),
            keys::flag("anew", "the strokes that are there go; default false")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing("solid:" + o.text("of"));
            const auto without = [&](const char* key) {
              if (draft.value(thing.file, thing.path).find(key)) draft.remove(thing.file, thing.path + "/" + key);
            };
            const bool along = !o.has("line_mm");
            without("fibre");
            if (along || o.flag("anew")) without("fibres_mm");
            if (!along) without("fibres_along");
            const std::string list = thing.path + "/fibres_mm";
            if (along) {
              draft.set(thing.file, thing.path + "/fibres_along", scene::json_flag(true));
            } else if (const JsonValue there = draft.value(thing.file, list); there.kind == JsonValue::Kind::array) {
              draft.insert(thing.file, list, there.items.size(), points(o.points("line_mm")));
            } else {
              draft.set(thing.file, list, scene::json_array({points(o.points("line_mm"))}));
            }
            const bool has_ratio = draft.value(thing.file, thing.path).find("fibre_ratio") != nullptr;
            if (o.has("ratio") || !has_ratio)
              draft.set(thing.file, thing.path + "/fibre_ratio", number(o.number("ratio", kUsualFibreRatio)));
          }};
}

}  // namespace

std::string list_of_brush(const JsonValue& body, const std::string& kind, const std::string& what,
                          const std::string& bonds) {
  if (what == "stiffness") return kind == "solid" || kind == "pouch" ? "/regions" : "";
  if (what == "hold") return kind == "solid" ? "/anchors" : kind == "pouch" ? "/held" : "";
  const scene::JsonMember* sets = body.find("bonds");
  for (std::size_t i = 0; sets && i < sets->value.items.size(); ++i) {
    const scene::JsonMember* name = sets->value.items[i].find("name");
    if (bonds.empty() || (name && name->value.text == bonds)) return tr("/bonds/{}/places", i);
  }
  return "";
}

std::vector<Operation> paint_operations() { return {paint(), fibres()}; }

}  // namespace trocar::modeller
