// Keys of marks: discs, and stripes around strands.
#include <algorithm>
#include <cctype>

#include <trocar/core/text.hpp>
#include <trocar/scene/files/keys.hpp>

namespace trocar::scene {
namespace {

constexpr std::size_t kLongestLabel = 3;

bool readable(const std::string& label) {
  return label.size() <= kLongestLabel &&
         std::all_of(label.begin(), label.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

bool is_stripe(const MarkSetting& m) { return m.stripe; }
bool is_disc(const MarkSetting& m) { return !m.stripe; }

void check_disc(const JsonObject& o, const MarkSetting& m) {
  if (o.names("width_mm")) o.fault("width_mm", "expected a disc's diameter_mm, got the width of a stripe");
  if (!o.names("place_mm")) o.fault(o.at(), "expected place_mm of a disc or at_mm of a stripe, got neither");
  const bool faces = length(m.normal) > 0 || (o.names("normal") && !o.has("normal"));
  if (!o.names("on") && !faces) o.fault(o.at(), "expected the normal of a disc in space, got none");
}

constexpr double kUsualStripe = 0.001;  // [m]

void check_mark(const JsonObject& o, MarkSetting& m, Context&) {
  m.stripe = o.names("at_mm");
  if (m.stripe) m.size = o.has("width_mm") ? units::mm.read(o.number("width_mm")) : kUsualStripe;
  if (m.colour.empty()) m.colour = kMarkColours.front();
  if (!readable(m.label)) o.fault("label", tr("expected at most three digits, got \"{}\"", m.label));
  if (!m.stripe) return check_disc(o, m);
  for (const char* key : {"place_mm", "normal", "diameter_mm", "label", "look", "high_mm"})
    if (o.names(key)) o.fault(key, "expected no normal of a stripe (at_mm), got one");
}

}  // namespace

const Table<MarkSetting>& mark() {
  using R = Rows<MarkSetting>;
  using M = MarkSetting;
  static const Table<M> table{
      "mark",
      "A disc, in space or on a body, pouch or wall, or a stripe around a strand. Exercises use it; it has no "
      "mechanics.",
      {needed(R::name("name", &M::name, "its name in exercises")),
       R::ref("on", Reference::To::marked, &M::on,
              "solid, pouch or wall that a disc lies on, strand that a stripe goes around; default: a disc in space"),
       R::vec3("place_mm", units::mm, &M::place, -kFar, kFar,
               "centre of a disc; on a body: the nearest point of that body")
           .only(is_disc),
       R::vec3("normal", units::one, &M::normal, -1, 1,
               "normal of a disc, any length; default: the outward normal of its body"),
       R::number("diameter_mm", units::mm, &M::size, 0.5, 50, "of a disc, default {}").only(is_disc),
       R::number("at_mm", units::mm, &M::s, 0, 5000, "arc length on the strand of a stripe's middle").only(is_stripe),
       R::own(keys::number("width_mm", 0.2, 50, "of a stripe, default 1"), nullptr,
              [](const M& m, bool) {
                return m.stripe ? std::optional<JsonValue>(json_number(in_file(units::mm, m.size))) : std::nullopt;
              }),
       R::text("label", &M::label, "written on a disc: at most three digits, default none"),
       R::ref("look", Reference::To::look, &M::look,
              "of a disc on a solid: tissue change that is drawn there instead of paint; default none"),
       R::number("high_mm", units::mm, &M::high, 0, 20, "height of the changed tissue, default {}").only(is_disc),
       R::own(
           keys::choice("colour", {kMarkColours.begin(), kMarkColours.end()}, "none: it is not drawn; default white"),
           [](const JsonObject& o, M& m, Context&) { m.colour = o.text("colour"); },
           [](const M& m, bool) { return json_text(m.colour); })},
      check_mark};
  return table;
}

}  // namespace trocar::scene
