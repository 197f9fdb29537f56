// Points of lines, sections of bodies, control points of nets.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/modeller/operations/kinds.hpp>
#include <trocar/modeller/operations/points.hpp>
#include <trocar/modeller/operations/values.hpp>
#include <trocar/scene/json/json_edit.hpp>

namespace trocar::modeller {
namespace {

namespace keys = scene::keys;
using scene::JsonObject;
using scene::JsonValue;

scene::Key of_key() { return scene::needed(keys::text("of", "the thing's name")); }
scene::Key list_key() {
  return keys::text("key",
                    "the list that holds it (sections, centreline_mm, base_mm, net_mm, path_mm ...), default: "
                    "the first one that the thing has");
}

/// The list's path in the thing; empty, with a fault told, where there is none.
std::string list_of(const JsonObject& o, const JsonValue& thing) {
  if (!o.has("key")) {
    const std::vector<PointList> lists = point_lists(thing);
    if (!lists.empty()) return lists.front().path;
    o.fault(o.at("of"), "expected a thing with points, got one that has none");
    return {};
  }
  const std::string path = "/" + o.text("key");
  const JsonValue* list = scene::json_at(thing, path);
  if (list && list->kind == JsonValue::Kind::array) return path;
  o.fault("key", tr("expected a list of points that the thing has, got \"{}\"", o.text("key")));
  return {};
}

Operation move_point() {
  return {{"move_point",
           "Moves a point, and those near it along with it.",
           {of_key(), list_key(), scene::needed(keys::integer("item", 0, 100000, "its number; of nets row by row")),
            keys::vec3("to_mm", -2000, 2000, "where it goes"), keys::vec3("by_mm", -2000, 2000, "or how far"),
            keys::number("soft_mm", 0, 1000, "how far from it others still go along, less and less; default 0: none"),
            keys::flag("symmetric", "the point on the other side of x = 0 does the same, mirrored; default false")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            const JsonValue value = draft.value(thing.file, thing.path);
            const std::string list = list_of(o, value);
            if (list.empty()) return;
            const std::vector<PlacedPoint> all = points_in(value, list);
            const std::size_t item = std::size_t(o.integer("item"));
            if (item >= all.size()) return o.fault("item", tr("expected a number below {}, got {}", all.size(), item));
            const Vec3d by = o.has("to_mm") ? o.vec3("to_mm") - all[item].at : o.vec3("by_mm");
            std::vector<std::pair<std::string, JsonValue>> values;
            for (const PlacedPoint& p : moved(all, item, by, o.number("soft_mm"), o.flag("symmetric")))
              values.emplace_back(thing.path + p.path, point(p.at));
            draft.set_all(thing.file, std::move(values));
          }};
}

JsonValue between(const JsonValue& a, const JsonValue& b, double share) {
  JsonValue out = a;
  if (a.kind == JsonValue::Kind::number && b.kind == a.kind) return number(a.number + share * (b.number - a.number));
  for (std::size_t i = 0; i < out.items.size() && i < b.items.size(); ++i)
    out.items[i] = between(a.items[i], b.items[i], share);
  for (scene::JsonMember& m : out.members)
    if (const scene::JsonMember* other = b.find(m.key)) m.value = between(m.value, other->value, share);
  return out;
}

Operation insert_point() {
  return {{"insert_point",
           "Puts a point, or a section, between two others.",
           {of_key(), list_key(),
            scene::needed(keys::integer("before", 0, 100000,
                                        "number of the one that it goes before; one more than there "
                                        "are: behind the last")),
            keys::number("share", 0, 1, "of the way from the one before to the next, default 0.5"),
            keys::vec3("at_mm", -2000, 2000, "where a point of a line goes, default: between them")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            const JsonValue value = draft.value(thing.file, thing.path);
            const std::string path = list_of(o, value);
            if (path.empty()) return;
            const std::vector<JsonValue>& items = scene::json_at(value, path)->items;
            const std::size_t before = std::size_t(o.integer("before"));
            if (before > items.size() || items.size() < 2)
              return o.fault("before", tr("expected a number up to {}, got {}", items.size(), before));
            const std::size_t first = before == 0 ? 0 : before == items.size() ? before - 2 : before - 1;
            double share = o.number("share", 0.5);  // beyond the ends it goes on as far again
            if (before == 0) share = -share;
            if (before == items.size()) share = 1 + share;
            JsonValue made = between(items[first], items[first + 1], share);
            if (o.has("at_mm") && is_point(made)) made = point(o.vec3("at_mm"));
            if (o.has("at_mm") && made.find("centre_mm"))
              for (scene::JsonMember& m : made.members)
                if (m.key == "centre_mm") m.value = point(o.vec3("at_mm"));
            draft.insert(thing.file, thing.path + path, before, made);
          }};
}

Operation remove_point() {
  return {{"remove_point",
           "Takes a point, a section or an anchor away.",
           {of_key(), list_key(), scene::needed(keys::integer("item", 0, 100000, "its number"))}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            const std::string path = list_of(o, draft.value(thing.file, thing.path));
            if (!path.empty())
              draft.remove(thing.file, scene::json_path(thing.path + path, std::size_t(o.integer("item"))));
          }};
}

Operation hold() {
  return {{"hold",
           "Holds the nodes of a solid, or of a pouch's wall, within a ball.",
           {of_key(), scene::needed(keys::vec3("centre_mm", -2000, 2000, "the ball's middle")),
            scene::needed(keys::number("radius_mm", 0.1, 500, "its radius")),
            keys::number("stiffness_N_m", 0, 1e6, "of all springs together, default 0: rigid; not for a pouch")}},
          [](const JsonObject& o, Draft& draft) {
            const Thing thing = draft.thing(o.text("of"));
            if (thing.kind != "solid" && thing.kind != "pouch")
              return o.fault("of", tr("expected a solid or a pouch, got a {}", thing.kind));
            JsonValue ball = scene::json_object();
            scene::put(ball, "centre_mm", point(o.vec3("centre_mm")));
            scene::put(ball, "radius_mm", number(o.number("radius_mm")));
            if (o.number("stiffness_N_m") > 0) scene::put(ball, "stiffness_N_m", number(o.number("stiffness_N_m")));
            const std::string list = thing.path + (thing.kind == "solid" ? "/anchors" : "/held");
            const JsonValue there = draft.value(thing.file, list);
            if (there.kind == JsonValue::Kind::array)
              draft.insert(thing.file, list, there.items.size(), ball);
            else
              draft.set(thing.file, list, scene::json_array({ball}));
          }};
}

}  // namespace

std::vector<PointList> point_lists(const JsonValue& thing) {
  std::vector<PointList> out;
  for (const scene::JsonMember& m : thing.members) {
    const JsonValue& v = m.value;
    const std::string path = scene::json_path("", m.key);
    if (m.key == "sections") out.push_back({path, m.key, PointList::sections});
    if (m.key == "anchors" || m.key == "held") out.push_back({path, m.key, PointList::balls});
    if (v.kind == JsonValue::Kind::array && !v.items.empty() && is_point(v.items[0]))
      out.push_back({path, m.key, PointList::line});
    if (v.kind == JsonValue::Kind::array && !v.items.empty() && !v.items[0].items.empty() &&
        is_point(v.items[0].items[0]))
      out.push_back({path, m.key, PointList::net});
    if (v.kind == JsonValue::Kind::object)  // a shape within: nurbs, tube
      for (PointList inner : point_lists(v)) out.push_back({path + inner.path, inner.key, inner.kind});
  }
  return out;
}

std::vector<PlacedPoint> points_in(const JsonValue& thing, const std::string& list) {
  std::vector<PlacedPoint> out;
  const JsonValue* items = scene::json_at(thing, list);
  for (std::size_t i = 0; items && i < items->items.size(); ++i) {
    const JsonValue& item = items->items[i];
    const std::string path = scene::json_path(list, i);
    if (is_point(item)) out.push_back({path, point_of(item)});
    if (const scene::JsonMember* centre = item.find("centre_mm"))
      if (is_point(centre->value)) out.push_back({path + "/centre_mm", point_of(centre->value)});
    for (std::size_t j = 0; j < item.items.size(); ++j)
      if (is_point(item.items[j])) out.push_back({scene::json_path(path, j), point_of(item.items[j])});
  }
  return out;
}

std::vector<PlacedPoint> moved(const std::vector<PlacedPoint>& all, std::size_t item, Vec3d by, double soft,
                               bool symmetric) {
  const Vec3d from = all[item].at, other{-from.x, from.y, from.z}, by_other{-by.x, by.y, by.z};
  const auto weight = [soft](double distance) {
    if (soft <= 0) return distance < 1e-9 ? 1.0 : 0.0;
    const double t = distance / soft;
    return t < 1 ? (1 - t * t) * (1 - t * t) : 0;
  };
  std::size_t partner = all.size();
  for (std::size_t i = 0; symmetric && i < all.size(); ++i)
    if (i != item && (partner == all.size() || length(all[i].at - other) < length(all[partner].at - other)))
      partner = i;
  std::vector<PlacedPoint> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    Vec3d way = i == item ? by : by * weight(length(all[i].at - from));
    if (partner < all.size())
      way = way + (i == partner ? by_other : by_other * weight(length(all[i].at - all[partner].at)));
    if (partner < all.size() && i == item) way = by;  // not twice where both sides reach each other
    if (i == partner) way = by_other;
    if (length(way) > 0) out.push_back({all[i].path, all[i].at + way});
  }
  return out;
}

std::vector<Operation> point_operations() { return {move_point(), insert_point(), remove_point(), hold()}; }

}  // namespace trocar::modeller
