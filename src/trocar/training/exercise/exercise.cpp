#include <algorithm>

#include <fmt/format.h>

#include <trocar/scene/files/library.hpp>
#include <trocar/training/exercise/exercise.hpp>

namespace trocar::training {
namespace {

using scene::JsonObject;
using scene::needed;
using scene::Shape;
namespace keys = scene::keys;

using Kind = Exercise::Kind;
constexpr const char* kKindNames[] = {"sterilisation", "bleeding_control"};
constexpr const char* kTaskNames[kTasks] = {"survey",      "identify", "present", "first_clip",
                                            "second_clip", "cut",      "check"};
constexpr const char* kBleedingTaskNames[kBleedingTasks] = {"find", "clip", "stop", "clear", "check"};

std::vector<std::string> task_names(Kind kind) {
  if (kind == Kind::sterilisation) return {kTaskNames, kTaskNames + kTasks};
  return {kBleedingTaskNames, kBleedingTaskNames + kBleedingTasks};
}

const Shape& value_shape() {
  static const Shape shape{"threshold",
                           "A number that decides, and where it comes from.",
                           {needed(keys::number("value", 0, 1e4, "in the unit that the key's name ends in")),
                            needed(keys::text("source", "a publication, or \"ours\""))}};
  return shape;
}
const Shape& range_shape() {
  static const Shape shape{
      "threshold range",
      "A closed interval that decides, and where it comes from.",
      {needed(keys::number("from", 0, 1e4, "lower end, in the unit of the key's name")),
       needed(keys::number("to", 0, 1e4, "upper end")), needed(keys::text("source", "a publication, or \"ours\""))}};
  return shape;
}
template <Kind kind>
const Shape& thresholds_shape() {
  static const Shape shape = [] {
    Shape s{"thresholds", "The numbers by which steps and errors are judged.", {}};
    for (const ThresholdRow& row : thresholds(kind))
      s.keys.push_back(needed(keys::object(row.key, row.range ? range_shape : value_shape, row.meaning)));
    return s;
  }();
  return shape;
}
const Shape& side_shape() {
  static const Shape shape{"side",
                           "One side of the patient.",
                           {needed(keys::name("name", "for results")), needed(keys::text("title", "for people")),
                            needed(keys::name("tube", "strand to be clipped and cut")),
                            needed(keys::name("ovary", "organ that the survey must show")),
                            keys::name("mesosalpinx", "fold that carries the tube, default: none"),
                            needed(keys::name("grasper_hand", "port of the hand that presents in the demonstration")),
                            needed(keys::name("scissors_hand", "port of the hand that cuts there"))}};
  return shape;
}
const Shape& named_shape() {
  static const Shape shape{"named body",
                           "A body of the scene and what people call it.",
                           {needed(keys::name("body", "solid, strand or fold")), keys::text("title", "for people")}};
  return shape;
}
template <Kind kind>
const Shape& task_shape() {
  static const Shape shape{
      "step",
      "What people are told about a step, and what it is worth.",
      {needed(keys::choice("step", task_names(kind), "which")), needed(keys::text("title", "for people")),
       needed(keys::text("hint", "how it is done")), needed(keys::number("weight", 0, 100, "in the score's quality"))}};
  return shape;
}
const Shape& penalty_shape() {
  static const Shape shape{
      "penalty",
      "What an error costs, and what follows from it.",
      {needed(keys::text("code", "the error's code")), needed(keys::text("name", "two or three words")),
       needed(keys::number("points", 0, 100, "taken from the score")),
       keys::flag("fail", "true: the attempt fails whatever its score"),
       needed(keys::text("meaning", "for people: what happened")), keys::text("hint", "for people: how to avoid it"),
       needed(keys::text("source", "of the penalty: a publication, or \"ours\"")),
       keys::texts("implies", "codes that always come with it"), keys::texts("may", "codes that can come with it"),
       keys::texts("leaves", "steps that the act does not complete")}};
  return shape;
}
const Shape& later_shape() {
  static const Shape shape{"later error",
                           "An error that cannot be detected yet.",
                           {needed(keys::text("code", "its code")), needed(keys::text("name", "two or three words")),
                            needed(keys::text("needs", "what the simulation lacks for it"))}};
  return shape;
}
const Shape& score_shape() {
  static const Shape shape{
      "score",
      "Shares of the score; what cannot be told is left out and the rest renormalised.",
      {needed(keys::number("quality", 0, 100, "of the weighted share of steps done")),
       needed(keys::number("time", 0, 100, "of the time, from longest to expert")),
       needed(keys::number("motion", 0, 100, "of the motion against a reference group, as soon as there is one")),
       needed(keys::text("source", "where the shares come from"))}};
  return shape;
}

/// The number of a threshold in SI, within its own bounds.
double checked(const JsonObject& o, const char* key, const ThresholdRow& row) {
  const double v = o.number(key);
  if (o.has(key) && (v < row.low || v > row.high))
    o.fault(key, fmt::format("expected a number in [{}, {}] for \"{}\", got {}", row.low, row.high, row.key, v));
  return v * row.unit;
}

void read_thresholds(const JsonObject& all, Exercise& e) {
  for (const ThresholdRow& row : thresholds(e.kind)) {
    std::string source;
    for (const JsonObject& o : all.objects(row.key)) {
      source = o.text("source");
      if (row.value) {
        row.value(e) = checked(o, "value", row);
        continue;
      }
      Range& range = row.range(e);
      range = {checked(o, "from", row), checked(o, "to", row)};
      if (range.low > range.high) o.fault("from", "expected from <= to, got an empty interval");
    }
    e.threshold_sources.push_back(source);
  }
}

std::vector<Named> read_named(const JsonObject& o, const char* key) {
  std::vector<Named> out;
  for (const JsonObject& n : o.objects(key)) {
    const std::string name = n.text("body");
    out.push_back({name, n.has("title") ? n.text("title") : name, n.at("body")});
  }
  return out;
}

void read_handling(const JsonObject& o, Handling& h) {
  h.delicate = read_named(o, "delicate");
  h.bowel = read_named(o, "bowel");
}

void read_goal(const JsonObject& o, BleedingControl& g) {
  g.applier = o.text("clip_applier");
  g.applier_at = o.at("clip_applier");
  read_handling(o, g);
}

void read_goal(const JsonObject& o, Sterilisation& g) {
  g.uterus = o.text("uterus");
  g.uterus_at = o.at("uterus");
  g.grasper = o.text("grasper");
  g.applier = o.text("clip_applier");
  g.scissors = o.text("scissors");
  g.grasper_at = o.at("grasper");
  g.applier_at = o.at("clip_applier");
  g.scissors_at = o.at("scissors");
  g.forbidden = read_named(o, "forbidden");
  read_handling(o, g);
  for (const JsonObject& s : o.objects("sides")) {
    Side side{s.text("name"),        s.text("title"),        s.text("tube"),          s.text("ovary"),
              s.text("mesosalpinx"), s.text("grasper_hand"), s.text("scissors_hand"), s.at("tube"),
              s.at("ovary"),         s.at("mesosalpinx"),    s.at("grasper_hand"),    s.at("scissors_hand")};
    for (const Side& other : g.sides) {
      if (other.tube == side.tube) s.fault("tube", "expected another tube than the other side's, got the same");
      if (other.name == side.name) s.fault("name", "expected another name than the other side's, got the same");
    }
    g.sides.push_back(side);
  }
  if (g.sides.size() > 2) o.fault("sides", "expected one or two sides, got more");
}

void read_tasks(const JsonObject& o, Exercise& e) {
  const std::vector<std::string> names = task_names(e.kind);
  std::vector<bool> told(names.size());
  e.tasks.resize(names.size());
  double weights = 0;
  for (const JsonObject& t : o.objects("steps")) {
    const std::string name = t.text("step");
    for (size_t i = 0; i < names.size(); ++i) {
      if (name != names[i]) continue;
      if (told[i]) t.fault("step", "expected each step once, got \"" + name + "\" again");
      told[i] = true;
      e.tasks[i] = {name, t.text("title"), t.text("hint"), t.number("weight")};
      weights += t.number("weight");
    }
  }
  if (!o.has("steps")) return;
  for (size_t i = 0; i < names.size(); ++i)
    if (!told[i]) o.fault("steps", "expected the step \"" + names[i] + "\", got none");
  if (weights <= 0) o.fault("steps", "expected a weight above 0, got none");
}

void read_penalties(const JsonObject& o, Exercise& e) {
  const std::vector<JsonObject> rows = o.objects("penalties");
  const std::vector<std::string> steps = task_names(e.kind);
  for (const JsonObject& p : rows) {
    Penalty penalty{p.text("code"), p.text("name"),   p.number("points"), p.flag("fail"), p.text("meaning"),
                    p.text("hint"), p.text("source"), p.texts("implies"), p.texts("may"), p.texts("leaves")};
    if (e.penalty(penalty.code)) p.fault("code", "expected each code once, got \"" + penalty.code + "\" again");
    for (const std::string& step : penalty.leaves)
      if (std::find(steps.begin(), steps.end(), step) == steps.end())
        p.fault("leaves", scene::unknown_name("step", step, steps));
    e.penalties.push_back(penalty);
  }
  std::vector<std::string> codes;
  for (const Penalty& p : e.penalties) codes.push_back(p.code);
  for (size_t i = 0; i < rows.size(); ++i)
    for (const char* key : {"implies", "may"})
      for (const std::string& code : key[0] == 'i' ? e.penalties[i].implies : e.penalties[i].may)
        if (!e.penalty(code)) rows[i].fault(key, scene::unknown_name("error code", code, codes));
  for (const JsonObject& l : o.objects("later")) e.later.push_back({l.text("code"), l.text("name"), l.text("needs")});
}

void read_score(const JsonObject& o, Exercise& e) {
  e.hold_time = o.number("hold_s");
  e.expert_time = o.number("expert_s");
  e.longest_time = o.number("longest_s");
  if (o.has("expert_s") && o.has("longest_s") && e.expert_time >= e.longest_time)
    o.fault("longest_s", "expected more than expert_s, got less or the same");
  e.pass_mark = o.number("pass_mark");
  for (const JsonObject& s : o.objects("score")) {
    e.quality_share = s.number("quality");
    e.time_share = s.number("time");
    e.motion_share = s.number("motion");
    if (s.has("quality") && s.has("time") && e.quality_share + e.time_share <= 0)
      s.fault("quality", "expected quality + time above 0, got none");
  }
}

/// What comes first in every kind of exercise, what is its own, what comes last.
template <Kind kind>
Shape shape_of(const char* meaning, std::vector<scene::Key> own) {
  Shape shape{"exercise",
              meaning,
              {
                  keys::text("$schema", "where editors find this kind of file's schema"),
                  keys::format(2),
                  needed(keys::name("name", "what the command line calls it")),
                  needed(keys::text("title", "for people")),
                  keys::text("summary", "two or three sentences for who chooses an exercise"),
                  needed(keys::text("scene", "path of the scene file, relative to this one")),
                  needed(keys::choice("kind", {kKindNames[0], kKindNames[1]}, "which task")),
              }};
  shape.keys.insert(shape.keys.end(), own.begin(), own.end());
  shape.keys.insert(
      shape.keys.end(),
      {
          keys::objects("delicate", named_shape, 0, "bodies that bear less pull, beside tubes that are operated on"),
          keys::objects("bowel", named_shape, 0, "bodies that bear less pinch"),
          needed(keys::name("clip_applier", "instrument that clips")),
          needed(keys::objects("steps", task_shape<kind>, 1, "each step once")),
          needed(keys::object("thresholds", thresholds_shape<kind>, "what decides")),
          needed(keys::object("score", score_shape, "how the score is put together")),
          needed(keys::number("hold_s", 0, 10, "a condition counts when it has been true this long")),
          needed(keys::number("expert_s", 1, 36000, "time that earns all points for time")),
          needed(keys::number("longest_s", 1, 36000, "time that earns none")),
          needed(keys::number("pass_mark", 0, 100, "score needed")),
          needed(keys::objects("penalties", penalty_shape, 1, "what errors cost, and what follows from them")),
          keys::objects("later", later_shape, 0, "errors that cannot be detected yet"),
          keys::texts("sources", "the publications that are named"),
      });
  return shape;
}

/// What a file says that it is; sterilisation where it says nothing that is known.
Kind kind_of(const scene::JsonValue& root) {
  const scene::JsonMember* kind = root.find("kind");
  const bool bleeding = kind && kind->value.kind == scene::JsonValue::Kind::string &&
                        kind->value.text == kKindNames[size_t(Kind::bleeding_control)];
  return bleeding ? Kind::bleeding_control : Kind::sterilisation;
}

}  // namespace

const Shape& sterilisation_shape() {
  static const Shape shape = shape_of<Kind::sterilisation>(
      "Tubal sterilisation in a scene, and what counts as done well.",
      {
          needed(keys::name("uterus", "organ that the survey must show")),
          needed(keys::objects("sides", side_shape, 1, "one or two")),
          keys::objects("forbidden", named_shape, 0, "what looks alike; all but the tubes is a wrong structure"),
          needed(keys::name("grasper", "instrument that presents a tube")),
          needed(keys::name("scissors", "instrument that cuts")),
      });
  return shape;
}

const Shape& bleeding_control_shape() {
  static const Shape shape =
      shape_of<Kind::bleeding_control>("A bleeding to be stopped in a scene, and what counts as done well.", {});
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
    e.kind = kind_of(document.root);
    const bool sterilisation = e.kind == Kind::sterilisation;
    const JsonObject o(document.root, sterilisation ? sterilisation_shape() : bleeding_control_shape(), document.file,
                       faults);
    e.name = o.text("name");
    e.title = o.text("title");
    e.summary = o.text("summary");
    e.scene = path.parent_path() / o.text("scene");
    if (const scene::Library library(path); !memory && o.has("scene") && !library.holds(e.scene))
      o.fault("scene", library.refusal(o.text("scene")));
    if (sterilisation)
      read_goal(o, e.goal);
    else
      read_goal(o, e.bleeding);
    read_tasks(o, e);
    for (const JsonObject& t : o.objects("thresholds")) read_thresholds(t, e);
    read_score(o, e);
    read_penalties(o, e);
  }
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return e;
}

}  // namespace trocar::training
