#include <trocar/numerics/portable.hpp>
#include <trocar/training/exercise.hpp>

namespace trocar::training {
namespace {

using scene::needed;
using scene::Shape;
namespace keys = scene::keys;

const Shape& range_shape(const char* name, double low, double high) {
  // One table per unit, made once.
  static std::vector<std::pair<std::string, Shape>> made;
  for (const auto& m : made)
    if (m.first == name) return m.second;
  made.reserve(8);
  made.push_back({name, Shape{name,
                              "A closed interval.",
                              {needed(keys::number("from", low, high, "lower end")),
                               needed(keys::number("to", low, high, "upper end"))}}});
  return made.back().second;
}
const Shape& millimetres() { return range_shape("range in millimetres", 0, 1000); }
const Shape& newtons() { return range_shape("range in newtons", 0, 100); }

const Shape& present_shape() {
  static const Shape shape{"present",
                           "The tube is held up, straight and without strain.",
                           {needed(keys::object("pull_N", newtons, "pull on the held tissue")),
                            needed(keys::number("straightness", 0, 1, "chord over length of the isthmus, at least"))}};
  return shape;
}
const Shape& clips_shape() {
  static const Shape shape{
      "clips",
      "Where and how the clips must sit.",
      {needed(keys::object("first_mm", millimetres, "place of the first clip from the uterus")),
       needed(keys::object("second_mm", millimetres, "place of the second")),
       needed(keys::object("distance_mm", millimetres, "between the two")),
       needed(keys::number("angle_deg", 0, 90, "largest angle from the tube's cross-section")),
       needed(keys::number("cover", 0, 1, "share of the cross-section between the legs, at least")),
       needed(keys::number("closing_s", 0, 60, "shortest closing time"))}};
  return shape;
}
const Shape& cut_shape() {
  static const Shape shape{"cut",
                           "Where and how far the tube must be cut.",
                           {needed(keys::number("margin_mm", 0, 100, "smallest distance from a clip")),
                            needed(keys::number("fraction", 0, 1, "of the cross-section, at least")),
                            needed(keys::number("beyond_mm", 0, 100, "deepest cut into the fold behind the tube"))}};
  return shape;
}
const Shape& penalty_shape() {
  static const Shape shape{
      "penalty",
      "What an error costs.",
      {needed(keys::text("code", "the error's code")), needed(keys::number("points", 0, 100, "taken from the score")),
       keys::flag("fail", "true: the attempt fails whatever its score"), needed(keys::text("meaning", "for people"))}};
  return shape;
}

Range range_of(const scene::JsonObject& o, const char* key, double unit) {
  const std::vector<scene::JsonObject> found = o.objects(key);
  if (found.empty()) return {};
  const Range r{found[0].number("from") * unit, found[0].number("to") * unit};
  if (r.low > r.high) o.fault(key, "expected from <= to, got an empty interval");
  return r;
}

constexpr double kMm = 1e-3;

void read_goal(const scene::JsonObject& o, Sterilisation& g) {
  g.tube = o.text("tube");
  g.grasper = o.text("grasper");
  g.applier = o.text("clip_applier");
  g.scissors = o.text("scissors");
  g.tube_at = o.at("tube");
  g.grasper_at = o.at("grasper");
  g.applier_at = o.at("clip_applier");
  g.scissors_at = o.at("scissors");
  g.pull_limit = o.number("pull_limit_N");
  for (const scene::JsonObject& p : o.objects("present")) {
    g.present_pull = range_of(p, "pull_N", 1);
    g.present_straightness = p.number("straightness");
  }
  for (const scene::JsonObject& c : o.objects("clips")) {
    g.first_clip = range_of(c, "first_mm", kMm);
    g.second_clip = range_of(c, "second_mm", kMm);
    g.clip_distance = range_of(c, "distance_mm", kMm);
    g.clip_angle = c.number("angle_deg") * portable::pi / 180;
    g.clip_cover = c.number("cover");
    g.clip_closing = c.number("closing_s");
  }
  for (const scene::JsonObject& c : o.objects("cut")) {
    g.cut_margin = c.number("margin_mm") * kMm;
    g.cut_fraction = c.number("fraction");
    g.cut_beyond = c.number("beyond_mm") * kMm;
  }
}

}  // namespace

const Shape& exercise_shape() {
  static const Shape shape{
      "exercise",
      "A task in a scene, and what counts as done well.",
      {
          keys::format(1),
          needed(keys::name("name", "what the command line calls it")),
          needed(keys::text("title", "for people")),
          needed(keys::text("scene", "path of the scene file, relative to this one")),
          needed(keys::choice("kind", {"sterilisation"}, "which task")),
          needed(keys::name("tube", "strand to be clipped and cut")),
          needed(keys::name("grasper", "instrument that presents the tube")),
          needed(keys::name("clip_applier", "instrument that clips")),
          needed(keys::name("scissors", "instrument that cuts")),
          needed(keys::object("present", present_shape, "step 3")),
          needed(keys::object("clips", clips_shape, "steps 4 and 5")),
          needed(keys::object("cut", cut_shape, "step 6")),
          needed(keys::number("pull_limit_N", 0, 100, "a pull beyond it is an over-force")),
          needed(keys::number("hold_s", 0, 10, "a condition counts when it has been true this long")),
          needed(keys::number("expert_s", 1, 36000, "time that earns all points for time")),
          needed(keys::number("longest_s", 1, 36000, "time that earns none")),
          needed(keys::number("pass_mark", 0, 100, "score needed")),
          needed(keys::objects("penalties", penalty_shape, 1, "what errors cost")),
          keys::texts("sources", "where the thresholds come from"),
      }};
  return shape;
}

const Penalty* Exercise::penalty(const std::string& code) const {
  for (const Penalty& p : penalties)
    if (p.code == code) return &p;
  return nullptr;
}

Exercise read_exercise(const std::filesystem::path& path, const scene::MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  const scene::JsonDocument document = scene::load_json(path, faults, memory);
  Exercise e;
  e.file = path;
  if (document.root.kind != scene::JsonValue::Kind::broken) {
    const scene::JsonObject o(document.root, exercise_shape(), document.file, faults);
    e.name = o.text("name");
    e.title = o.text("title");
    e.scene = path.parent_path() / o.text("scene");
    e.hold_time = o.number("hold_s");
    e.expert_time = o.number("expert_s");
    e.longest_time = o.number("longest_s");
    if (o.has("expert_s") && o.has("longest_s") && e.expert_time >= e.longest_time)
      o.fault("longest_s", "expected more than expert_s, got less or the same");
    e.pass_mark = o.number("pass_mark");
    read_goal(o, e.goal);
    for (const scene::JsonObject& p : o.objects("penalties"))
      e.penalties.push_back({p.text("code"), p.number("points"), p.flag("fail"), p.text("meaning")});
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return e;
}

}  // namespace trocar::training
