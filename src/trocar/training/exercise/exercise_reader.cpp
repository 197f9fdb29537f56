// Reads an exercise file, with those that it is like and the files of common rules that they include.
#include <algorithm>
#include <cmath>
#include <deque>
#include <map>

#include <fmt/format.h>

#include <trocar/core/controls/control_keys.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/json/like.hpp>
#include <trocar/training/exercise/rule_files.hpp>
#include <trocar/training/exercise/rules.hpp>
#include <trocar/training/exercise/scoreboard.hpp>

namespace trocar::training {
namespace {

using scene::JsonObject;
using scene::JsonValue;

namespace fs = std::filesystem;

constexpr std::size_t kMostLayers = 16;  // of exercises that are like others

/// Of an exercise that is like another one.
const scene::Shape& like_shape() {
  static const scene::Shape shape = scene::like_another(exercise_shape());
  return shape;
}

class ExerciseReader {
 public:
  ExerciseReader(const fs::path& path, const scene::MemoryFiles* memory, Exercise& exercise, Faults& faults)
      : m_path(path), m_memory(memory), m_exercise(exercise), m_faults(faults), m_library(path) {}

  void read() {
    m_exercise.file = m_path;
    if (!open(m_path)) return;
    head();
    score();
    RuleFiles rules(m_exercise, m_faults);
    if (!includes(rules)) return m_exercise.steps.clear();  // what follows from missing rules is no fault of its own
    std::vector<const JsonObject*> limits;
    for (const Layer& l : m_layers) limits.push_back(&l.o);
    rules.read({limits, said("sets").o, said("errors").o}, true);
    own_steps();
    const JsonObject& detailed = said("details").o;
    for (const JsonObject& d : detailed.objects("details"))
      m_exercise.details.push_back({d.value(), detailed.at().file});
    const JsonObject& shown = said("demonstration").o;
    if (const scene::JsonMember* d = shown.value().find("demonstration"))
      m_exercise.demonstration = {d->value, shown.at().file};
    rehearsed(m_layers.front().o);  // another scene asks for other choices
    for (const JsonObject& l : said("later").o.objects("later"))
      m_exercise.later.push_back({l.text("code"), l.text("name"), l.text("needs")});
    words();
    codes();
    unused_limits();
  }

 private:
  /// An exercise's file, and below it those that it is like: each stands in for what the ones above do not say.
  struct Layer {
    JsonObject o;
    fs::path path;
  };

  /// @return false where there is nothing to continue with
  bool open(const fs::path& path) {
    const scene::JsonDocument& document = load(path);
    if (document.root.kind == JsonValue::Kind::broken || of_another_format(document)) return false;
    const bool is_like = document.root.find(scene::kLike) != nullptr;
    const JsonObject o(document.root, is_like ? like_shape() : exercise_shape(), document.file, m_faults);
    m_layers.push_back({o, path});
    if (!o.has(scene::kLike)) return true;
    for (const char* key : {"title", "scene"})
      if (!o.names(key))
        o.fault(o.at(), tr("expected the key \"{}\" also in an exercise that has \"like\", got none", key));
    return below(o, located(path.parent_path() / o.text(scene::kLike)));
  }
  /// One of the exercise's files. All of them together hold no more than one may.
  const scene::JsonDocument& load(const fs::path& path) {
    m_files.push_back(scene::load_json(path, m_faults, m_memory, {kMaxExerciseValues, kLongestExerciseText}));
    scene::JsonDocument& document = m_files.back();
    m_values += document.values;
    if (m_values <= kMaxExerciseValues || document.root.kind == JsonValue::Kind::broken) return document;
    fault(document.file, document.root,
          tr("expected at most {} values in all files of an exercise together, got more", kMaxExerciseValues));
    document.root.kind = JsonValue::Kind::broken;
    return document;
  }
  /// A file that a file names, wherever in the library it lies.
  fs::path located(const fs::path& file) const {
    return m_memory ? file.lexically_normal() : scene::located(file.lexically_normal());
  }
  bool below(const JsonObject& o, const fs::path& path) {
    const auto same = [&path](const Layer& l) { return l.path.lexically_normal() == path; };
    if (std::any_of(m_layers.begin(), m_layers.end(), same) || m_layers.size() >= kMostLayers)
      o.fault(scene::kLike, tr("expected a chain of at most {} exercises through \"like\", without a cycle, got "
                               "one more: {}",
                               kMostLayers, path.generic_string()));
    else if (!m_memory && !m_library.holds(path))
      o.fault(scene::kLike, m_library.refusal(o.text(scene::kLike)));
    else
      return open(path);
    return false;
  }
  /// Who says it.
  const Layer& said(const char* key) const {
    const auto end = scene::is_own(key) ? m_layers.begin() + 1 : m_layers.end();
    const auto says = std::find_if(m_layers.begin(), end, [key](const Layer& l) { return l.o.names(key); });
    return says == end ? m_layers.front() : *says;
  }
  std::string text(const char* key) const { return said(key).o.text(key); }
  double number(const char* key) const { return said(key).o.number(key); }

  bool of_another_format(const scene::JsonDocument& document) {
    const scene::JsonMember* format = document.root.find("format");
    if (!format || format->value.kind != JsonValue::Kind::number || format->value.number >= 3) return false;
    fault(document.file, format->value,
          tr("expected format 3, got {:g}: format 2 is no longer supported, see docs/guides/authoring_exercises.md",
             format->value.number));
    return true;
  }

  void fault(const std::string& file, const JsonValue& at, std::string message) {
    scene::tell(m_faults, {{file, at.line, at.column}, std::move(message)});
  }

  void head() {
    m_exercise.name = text("name");
    m_exercise.title = text("title");
    m_exercise.summary = text("summary");
    m_exercise.order = said("order").o.integer("order", 1000);
    m_exercise.group = text("group");
    m_exercise.level = said("level").o.integer("level", 1);
    const Layer& where = said("scene");
    m_exercise.scene = where.path.parent_path() / where.o.text("scene");
    if (!m_memory && where.o.has("scene")) m_exercise.scene = scene::located(m_exercise.scene);
    if (!m_memory && where.o.has("scene") && !m_library.holds(m_exercise.scene)) {
      where.o.fault("scene", m_library.refusal(where.o.text("scene")));
      m_exercise.scene.clear();  // it is not opened: faults quote what a file says
    }
  }

  void score() {
    Exercise& e = m_exercise;
    e.hold_time = number("hold_s");
    e.expert_time = number("expert_s");
    e.longest_time = number("longest_s");
    const JsonObject& longest = said("longest_s").o;
    if (said("expert_s").o.has("expert_s") && longest.has("longest_s") && e.expert_time >= e.longest_time)
      longest.fault("longest_s", "expected more than expert_s, got less or the same");
    e.pass_mark = number("pass_mark");
    for (const JsonObject& s : said("score").o.objects("score")) {
      e.quality_share = s.number("quality");
      e.time_share = s.number("time");
      e.motion_share = s.number("motion");
      if (s.has("quality") && s.has("time") && e.quality_share + e.time_share <= 0)
        s.fault("quality", "expected quality + time above 0, got none");
    }
  }

  /// @return false: some of the rules are missing
  bool includes(RuleFiles& rules) {
    const JsonObject& o = said("includes").o;
    const std::vector<std::string> names = o.texts("includes");
    bool all = !o.names("includes") || o.has("includes");
    for (std::size_t i = 0; i < names.size(); ++i) {
      const fs::path path = located(said("includes").path.parent_path() / names[i]);
      if (!m_memory && !m_library.holds(path)) {
        o.fault(o.at("includes", i), m_library.refusal(names[i]));
        all = false;
        continue;
      }
      const scene::JsonDocument& document = load(path);
      if (document.root.kind == JsonValue::Kind::broken) {
        all = false;
        continue;
      }
      const JsonObject common(document.root, common_rules_shape(), document.file, m_faults);
      rules.read({{&common}, common, common}, false);
      steps(common);
    }
    return all;
  }

  void steps(const JsonObject& o) {
    const std::string file = o.at().file;
    for (const JsonObject& s : o.objects("steps")) {
      StepText text{s.text("step"),        s.text("title"),    s.text("hint"),   s.text("for_each"),
                    s.number("weight", 1), s.flag("optional"), {s.value(), file}};
      check_hint(s, text.hint);
      if (m_exercise.step(text.name)) s.fault("step", "expected each step once, got \"" + text.name + "\" again");
      m_exercise.steps.push_back(std::move(text));
    }
  }
  static void check_hint(const JsonObject& o, const std::string& hint) {
    std::vector<std::string> known;
    for (const core::ControlKey& key : core::control_keys()) known.emplace_back(key.name);
    for (const std::string& name : core::unknown_keys(hint)) o.fault("hint", scene::unknown_name("key", name, known));
  }
  /// They come after those of included files.
  void own_steps() {
    const JsonObject& o = said("steps").o;
    steps(o);
    const auto weighs = [](const StepText& s) { return s.weight > 0; };
    if (o.has("steps") && std::none_of(m_exercise.steps.begin(), m_exercise.steps.end(), weighs))
      o.fault("steps", "expected a weight above 0, got none");
  }

  void rehearsed(const JsonObject& o) {
    for (const JsonObject& r : o.objects("rehearsed")) {
      RecordedChoices one{std::uint64_t(r.number("seed")), {}};
      const scene::JsonMember* choices = r.value().find("choices");
      if (choices && choices->value.kind != JsonValue::Kind::array)
        r.fault("choices", "expected a list of choices, got " + scene::shown(choices->value));
      else if (choices)
        for (const JsonValue& c : choices->value.items) add_choice(c, o.at().file, one.choices);
      if (m_exercise.recorded_choices_for(one.seed)) r.fault("seed", "expected each seed once, got it again");
      m_exercise.recorded_choices.push_back(std::move(one));
    }
  }
  void add_choice(const JsonValue& v, const std::string& file, Choices& all) {
    const std::size_t faults = m_faults.size();
    const Choice next = choice(v, file);
    if (m_faults.size() != faults) return;
    if (!all.empty() && next.at <= all.back().at)
      fault(file, v, tr("expected ascending decision points, each once, got {} after {}", next.at, all.back().at));
    all.push_back(next);
  }
  Choice choice(const JsonValue& v, const std::string& file) {
    const auto whole = [&v](std::size_t i, int most) {
      const JsonValue& n = v.items[i];
      return n.kind == JsonValue::Kind::number && n.number >= 0 && n.number <= most && n.number == std::floor(n.number);
    };
    if (v.kind == JsonValue::Kind::array && v.items.size() == 2 && whole(0, kMostChoice) && whole(1, kMostPerturbation))
      return {int(v.items[0].number), int(v.items[1].number)};
    fault(file, v,
          tr("expected [decision point, perturbation], two whole numbers up to {}, got {}", kMostPerturbation,
             scene::shown(v)));
    return {};
  }

  /// Limits go into the texts of errors; steps are reported with their elements, later.
  void words() {
    const Names names(m_exercise.limits, {});
    for (Penalty& p : m_exercise.penalties)
      for (std::string* text : {&p.name, &p.meaning, &p.hint})
        *text = core::with_keys(names.text(*text), core::KeyDevice::mouse_and_keys);
  }

  void codes() {
    std::vector<std::string> known;
    for (const Penalty& p : m_exercise.penalties) known.push_back(p.code);
    for (const Penalty& p : m_exercise.penalties) {
      for (const std::vector<std::string>* list : {&p.implies, &p.may})
        for (const std::string& code : *list)
          if (!m_exercise.penalty(code)) fault_of(p, *list == p.may ? "may" : "implies", "error code", code, known);
      std::vector<std::string> steps;
      for (const StepText& s : m_exercise.steps) steps.push_back(s.name);
      for (const std::vector<std::string>* list : {&p.leaves, &p.misses})
        for (const std::string& step : *list)
          if (!m_exercise.step(step.substr(0, step.find('('))))
            fault_of(p, list == &p.leaves ? "leaves" : "misses", "step", step, steps);
    }
  }
  void fault_of(const Penalty& p, const char* key, const char* what, const std::string& word,
                const std::vector<std::string>& known) {
    if (m_faults.size() > scene::kMaxFaults) return;  // words cost more than what they say
    const scene::JsonMember* m = p.part.value.find(key);
    fault(p.part.file, m ? m->value : p.part.value, scene::unknown_name(what, word, known));
  }

  /// A limit that decides nothing is a mistake: somebody believes in it.
  void unused_limits() {
    std::map<std::string, bool> used;
    for (const Limit& l : m_exercise.limits) used[l.name] = false;
    for (const scene::JsonDocument& d : m_files) note_references(d.root, used);
    for (const Limit& l : m_exercise.limits)
      if (!used[l.name])
        scene::tell(m_faults, {l.at, tr("expected a limit that is used (\"${}\"), got one without a use", l.name)});
  }
  static void note_references(const JsonValue& v, std::map<std::string, bool>& used) {
    if (v.kind == JsonValue::Kind::string && v.text.size() > 1 && v.text[0] == '$')
      if (const auto at = used.find(v.text.substr(1)); at != used.end()) at->second = true;
    for (const JsonValue& item : v.items) note_references(item, used);
    for (const scene::JsonMember& m : v.members) note_references(m.value, used);
  }

  const fs::path& m_path;
  const scene::MemoryFiles* m_memory;
  Exercise& m_exercise;
  Faults& m_faults;
  scene::Library m_library;
  std::deque<scene::JsonDocument> m_files;  ///< they stay where they are
  std::deque<Layer> m_layers;
  int m_values = 0;  ///< of m_files
};

/// The first of those that say the same of the same place.
void keep_each_once(Faults& faults) {
  Faults kept;
  for (core::Fault& f : faults) {
    const auto same = [&f](const core::Fault& k) {
      return k.at.line == f.at.line && k.at.column == f.at.column && k.at.file == f.at.file && k.message == f.message;
    };
    if (std::none_of(kept.begin(), kept.end(), same)) kept.push_back(std::move(f));
  }
  faults = std::move(kept);
}

}  // namespace

Exercise read_exercise(const fs::path& path, Faults& faults, const scene::MemoryFiles* memory) {
  Exercise e;
  ExerciseReader(path, memory, e, faults).read();
  if (!e.steps.empty()) {
    Scoreboard board(e, Mode::assessed);
    const Rules rules(e, nullptr, 0, board, faults);
  }
  keep_each_once(faults);
  return e;
}

Exercise read_exercise(const fs::path& path, const scene::MemoryFiles* memory) {
  Faults faults;
  Exercise e = read_exercise(path, faults, memory);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return e;
}

void check_in_scene(const Exercise& exercise, const sim::Model& model, Faults& faults) {
  if (exercise.steps.empty()) return;
  Scoreboard board(exercise, Mode::assessed);
  const Rules rules(exercise, &model, 0, board, faults);
  keep_each_once(faults);
}

}  // namespace trocar::training
