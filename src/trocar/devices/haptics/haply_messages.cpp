#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/json.hpp>
#include <trocar/devices/haptics/haply_messages.hpp>

namespace trocar::devices {
namespace {

constexpr std::size_t kLongestId = 64;
constexpr char kProfile[] = "trocar:train";

/// A member of an object, or null: whatever the other side sends, nothing throws.
const Json* member(const Json* object, const char* key) {
  if (!object || !object->is_object()) return nullptr;
  const auto found = object->find(key);
  return found == object->end() ? nullptr : &*found;
}
const Json* first_of(const Json* list) { return list && list->is_array() && !list->empty() ? &list->front() : nullptr; }
double number(const Json* object, const char* key) {
  const Json* value = member(object, key);
  return value && value->is_number() ? value->get<double>() : std::nan("");
}
Vec3d vector_of(const Json* o) { return {number(o, "x"), number(o, "y"), number(o, "z")}; }
bool is_true(const Json* value) { return value && value->is_boolean() && value->get<bool>(); }

/// Identifiers go into what is sent: nothing but letters, digits and what holds them together.
bool is_identifier(const std::string& id) {
  return !id.empty() && id.size() <= kLongestId && std::all_of(id.begin(), id.end(), [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
  });
}

/// The grip with three buttons, or the older one with a button and a ring that closes.
void read_grip(const Json& message, HaplyState& out) {
  const Json* wireless = member(first_of(member(&message, "wireless_verse_grip")), "state");
  const Json* wired = member(first_of(member(&message, "verse_grip")), "state");
  const Json* state = wireless ? wireless : wired;
  if (!state) return;
  const Json* turn = member(state, "orientation");
  const Vec3d v = vector_of(turn);
  const Quatd q{number(turn, "w"), v.x, v.y, v.z};
  if (const double size = dot(q, q); size > 0.5 && size < 2) {
    out.sample.rotation = normalised(q);
    out.turns = true;
  }
  const Json* buttons = member(state, "buttons");
  out.sample.switches = (is_true(member(state, "button")) || is_true(member(buttons, "a")) ? 1u : 0u) |
                        (is_true(member(buttons, "b")) ? 8u : 0u) | (is_true(member(buttons, "c")) ? 4u : 0u);
}

}  // namespace

std::optional<HaplyState> read_haply(std::string_view text) {
  const Json message = Json::parse(text.begin(), text.end(), nullptr, false);
  const Json* inverse = first_of(member(&message, "inverse3"));
  const Json* id = member(inverse, "device_id");
  if (!id || !id->is_string()) return {};
  HaplyState out;
  out.device = id->get<std::string>();
  if (!is_identifier(out.device)) return {};
  const Json* type = member(member(inverse, "config"), "type");
  out.small = type && type->is_string() && type->get_ref<const std::string&>() == "minverse";
  out.sample.position = vector_of(member(member(inverse, "state"), "cursor_position"));
  read_grip(message, out);
  if (!plausible(out.sample)) return {};
  return out;
}

std::string haply_command(const std::string& device, Vec3d f, bool first) {
  const std::string session =
      first ? fmt::format(R"("session":{{"configure":{{"profile":{{"name":"{}"}}}}}},)", kProfile) : std::string();
  return fmt::format(
      R"({{{}"inverse3":[{{"device_id":"{}","commands":{{"set_cursor_force":{{"values":{{"x":{:.5f},"y":{:.5f},"z":{:.5f}}}}}}}}}]}})",
      session, device, f.x, f.y, f.z);
}

}  // namespace trocar::devices
