#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include <trocar/core/files.hpp>
#include <trocar/core/foreign/foreign_text.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/chains/joints.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/mechanisms/mechanism_keys.hpp>
#include <trocar/scene/mechanisms/quantity_text.hpp>
#include <trocar/scene/mechanisms/urdf.hpp>
#include <trocar/scene/mechanisms/urdf_warnings.hpp>

namespace trocar::scene {

namespace mechanism_reading {  // what follows is full of the names of kinematics
namespace {

using namespace kinematics;

constexpr double kMillimetre = 1e-3, kDegree = portable::pi / 180;

struct ClosureWord {
  const char* word;
  unsigned directions;
};
constexpr ClosureWord kClosureWords[] = {{"rigid", kT | kR},
                                         {"pin", kT | kRx | kRy},
                                         {"ball", kT},
                                         {"slider", kTy | kTz | kR},
                                         {"cylinder", kTx | kTy | kRx | kRy},
                                         {"slot", kTy | kTz},
                                         {"through", kTx | kTy},
                                         {"plane", kTz},
                                         {"universal", kT | kRz}};
constexpr const char* kDirectionWords[] = {"tx", "ty", "tz", "rx", "ry", "rz"};

constexpr std::pair<const char*, JointKind> kJointWords[] = {
    {"fixed", JointKind::fixed},         {"revolute", JointKind::revolute},
    {"prismatic", JointKind::prismatic}, {"cylindrical", JointKind::cylindrical},
    {"helical", JointKind::helical},     {"universal", JointKind::universal},
    {"spherical", JointKind::spherical}, {"planar", JointKind::planar}};

/// Where the keys are that a description's fields were made of.
struct KeyOfField {
  const char *field, *key;
};
constexpr KeyOfField kFieldKeys[] = {
    {"axis", "joint"}, {"limits", "joint"}, {"start", "joint"}, {"inertia", "inertia_g_mm2"}, {"of", "terms"}};

class MechanismReading {
 public:
  MechanismReading(const JsonObject& file, std::vector<core::Fault>& faults) : m_file(file), m_faults(faults) {}

  MechanismDescription read() {
    const std::size_t before = m_faults.size();
    d.name = m_file.text("name");
    d.title = m_file.text("title");
    d.gravity = m_file.vec3("gravity_m_s2", d.gravity);
    for (const JsonObject& o : m_file.objects("parameters")) parameter(o);
    for (const JsonObject& o : keep("links")) link(o);
    for (const JsonObject& o : keep("motors")) motor(o);
    for (const JsonObject& o : keep("couplings")) coupling(o);
    for (const JsonObject& o : keep("actuators")) actuator(o);
    for (const JsonObject& o : keep("frames")) d.frames.push_back(frame(o));
    for (const JsonObject& o : keep("closures")) closure(o);
    for (const JsonObject& o : keep("springs")) spring(o);
    if (m_faults.size() == before)
      for (const MechanismFault& f : check(d)) tell(m_faults, {place_of(f), f.message});
    if (m_faults.size() == before) check_units();
    std::stable_sort(m_faults.begin() + std::ptrdiff_t(before), m_faults.end(),
                     [](const core::Fault& a, const core::Fault& b) {
                       return std::pair(a.at.line, a.at.column) < std::pair(b.at.line, b.at.column);
                     });
    return std::move(d);
  }

 private:
  std::vector<JsonObject>& keep(const char* key) {
    m_lists.emplace_back(key, m_file.objects(key));
    return m_lists.back().second;
  }

  // ---- dimensions

  static const JsonValue* value_at(const JsonObject& o, const char* key) {
    const JsonMember* member = o.value().find(key);
    return member && member->value.kind != JsonValue::Kind::broken ? &member->value : nullptr;
  }
  Quantity quantity(const JsonObject& o, const core::Location& at, const JsonValue& value, Measure measure, double unit,
                    double most) {
    QuantityReading r;
    if (value.kind == JsonValue::Kind::number)
      r.quantity.constant = value.number * unit;
    else if (value.kind == JsonValue::Kind::string)
      r = read_quantity(value.text, d.parameters, measure, unit);
    else
      r.fault = tr("expected a number or a sum of parameters, got {}", shown(value));
    const double in_file = r.fault.empty() ? value_of(r.quantity, d.parameters) / unit : 0;
    if (!(std::fabs(in_file) <= most)) r.fault = tr("expected at most {} either way, got {}", most, in_file);
    if (!r.fault.empty()) {
      o.fault(at, r.fault);
      return {};
    }
    return r.quantity;
  }
  Quantity one(const JsonObject& o, const char* key, Measure measure, double unit, double most) {
    const JsonValue* v = value_at(o, key);
    return v ? quantity(o, o.at(key), *v, measure, unit, most) : Quantity{};
  }
  Quantity mm(const JsonObject& o, const char* key) { return one(o, key, Measure::length, kMillimetre, kFarMechanism); }
  Quantity deg(const JsonObject& o, const char* key) { return one(o, key, Measure::angle, kDegree, kMostDegrees); }
  Quantities three(const JsonObject& o, const char* key, Measure measure, double unit, double most) {
    Quantities out{};
    const JsonValue* v = value_at(o, key);
    if (!v) return out;
    if (v->kind != JsonValue::Kind::array || v->items.size() != 3) {
      o.fault(key, tr("expected three numbers or sums of parameters, got {}",
                      v->kind == JsonValue::Kind::array ? fmt::format("{}", v->items.size()) : shown(*v)));
      return out;
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (v->items[k].kind != JsonValue::Kind::broken)
        out[k] = quantity(o, o.at(key, k), v->items[k], measure, unit, most);
    return out;
  }
  Quantities three_mm(const JsonObject& o, const char* key) {
    return three(o, key, Measure::length, kMillimetre, kFarMechanism);
  }
  Quantities three_deg(const JsonObject& o, const char* key) {
    return three(o, key, Measure::angle, kDegree, kMostDegrees);
  }

  kinematics::Placement placement(const JsonObject& o) {
    kinematics::Placement p;
    p.at = three_mm(o, "at_mm");
    p.turn = three_deg(o, "turn_deg");
    for (const JsonObject& dh : o.objects("dh")) {
      if (o.names("at_mm") || o.names("turn_deg"))
        o.fault("dh", "expected either \"dh\" or \"at_mm\" and \"turn_deg\", got both");
      p = {};
      p.dh = true;
      p.at[0] = mm(dh, "a_mm");
      p.at[2] = mm(dh, "d_mm");
      p.turn[0] = deg(dh, "alpha_deg");
      p.turn[2] = deg(dh, "theta_deg");
    }
    return p;
  }
  NamedFrame frame(const JsonObject& o) {
    return {o.names("name") ? o.text("name") : "", o.text("link", "ground"), placement(o)};
  }
  NamedFrame end(const JsonObject& o, const char* key) {
    NamedFrame out;
    for (const JsonObject& e : o.objects(key)) out = {"", e.text("link", "ground"), placement(e)};
    return out;
  }

  // ---- parts

  void parameter(const JsonObject& o) {
    Parameter p;
    p.name = o.text("name");
    double unit = 1;
    int said = 0;
    const auto is = [&](const char* key, Measure measure, double its_unit) {
      if (!o.names(key)) return;
      ++said;
      p.measure = measure;
      unit = its_unit;
      p.value = o.number(key) * unit;
    };
    is("length_mm", Measure::length, kMillimetre);
    is("angle_deg", Measure::angle, kDegree);
    is("ratio", Measure::ratio, 1);
    if (said != 1)
      o.fault(o.at(), tr("expected one of \"length_mm\", \"angle_deg\", \"ratio\", got {}", said ? "more" : "none"));
    if (p.name.find('-') != p.name.npos || (!p.name.empty() && p.name[0] >= '0' && p.name[0] <= '9'))
      o.fault("name", tr("expected letters, digits and _, a letter first, got \"{}\"", p.name));
    const std::vector<double> between = o.numbers("between");
    if (between.size() == 2) {
      p.low = between[0] * unit;
      p.high = between[1] * unit;
      if (!(p.low <= p.value && p.value <= p.high))
        o.fault("between", "expected bounds around the value, got some that are not");
    }
    p.tolerance = o.number("plus_minus") * unit;
    d.parameters.push_back(std::move(p));
  }

  /// Limits and starts of a joint's coordinates, in their order, of what the file says of angles and of slides.
  void values(const JsonObject& o, const std::vector<Measure>& measures, std::vector<double>& limits,
              std::vector<double>& start) {
    const auto lay = [&](const char* deg_key, const char* mm_key, std::size_t each, double missing_low,
                         double missing_high, std::vector<double>& out) {
      if (!o.names(deg_key) && !o.names(mm_key)) return;
      std::vector<double> angles = numbers(o, deg_key), slides = numbers(o, mm_key);
      const auto count = [&](Measure measure) {
        return each * std::size_t(std::count(measures.begin(), measures.end(), measure));
      };
      const auto wrong = [&](const char* key, std::size_t got, std::size_t wanted) {
        if (got == wanted || got == 0) return false;
        o.fault(key, tr("expected {} numbers, got {}", wanted, got));
        return true;
      };
      if (wrong(deg_key, angles.size(), count(Measure::angle)) || wrong(mm_key, slides.size(), count(Measure::length)))
        return;
      std::size_t a = 0, s = 0;
      for (const Measure measure : measures) {
        const bool angle = measure == Measure::angle;
        const std::vector<double>& from = angle ? angles : slides;
        std::size_t& at = angle ? a : s;
        for (std::size_t k = 0; k < each; ++k, ++at)
          out.push_back(at < from.size() ? from[at] * (angle ? kDegree : kMillimetre)
                                         : (k == 0 ? missing_low : missing_high));
      }
    };
    const double far = 1e6;
    lay("limits_deg", "limits_mm", 2, -far, far, limits);
    lay("start_deg", "start_mm", 1, 0, 0, start);
  }
  static std::vector<double> numbers(const JsonObject& o, const char* key) {
    std::vector<double> out = o.numbers(key);
    if (out.empty() && o.has(key)) out.push_back(o.number(key));
    return out;
  }

  static std::vector<Measure> measures_of(JointKind kind) {
    constexpr Measure a = Measure::angle, s = Measure::length;
    switch (kind) {
      case JointKind::revolute:
      case JointKind::helical:
        return {a};
      case JointKind::prismatic:
        return {s};
      case JointKind::cylindrical:
        return {a, s};
      case JointKind::universal:
        return {a, a};
      case JointKind::spherical:
        return {a, a, a};
      case JointKind::planar:
        return {s, s, a};
      case JointKind::fixed:
        break;
    }
    return {};
  }

  void link(const JsonObject& o) {
    Link l;
    l.name = o.text("name");
    l.parent = o.text("parent", "ground");
    for (const JsonObject& j : o.objects("joint")) {
      for (const auto& [word, kind] : kJointWords)
        if (j.text("kind") == word) l.joint.kind = kind;
      l.joint.name = j.text("name");
      l.joint.axis = j.vec3("axis", l.joint.axis);
      if (j.has("axis") && !(length(l.joint.axis) > 1e-6)) j.fault("axis", "expected a direction, got three zeros");
      l.joint.pitch = mm(j, "pitch_mm");
      if (j.has("kind") && (l.joint.kind == JointKind::helical) != j.names("pitch_mm"))
        j.fault(j.at(j.names("pitch_mm") ? "pitch_mm" : "kind"),
                tr("expected \"pitch_mm\" of a helical joint and of no other, got {}",
                   j.names("pitch_mm") ? "it of another" : "a helical joint without"));
      values(j, measures_of(l.joint.kind), l.joint.limits, l.joint.start);
    }
    l.joint.place = placement(o);
    l.mass = o.number("mass_g") * 1e-3;
    l.centre = kMillimetre * o.vec3("centre_mm");
    const std::vector<double> inertia = o.numbers("inertia_g_mm2");
    for (std::size_t k = 0; k < std::min<std::size_t>(6, inertia.size()); ++k) l.inertia[k] = inertia[k] * 1e-9;
    for (const JsonObject& s : o.objects("shapes")) l.shapes.push_back(shape(s));
    d.links.push_back(std::move(l));
  }

  kinematics::Shape shape(const JsonObject& o) {
    kinematics::Shape s;
    const std::string kind = o.text("kind");
    const bool box = kind == "box";
    s.kind = box ? ShapeKind::box : kind == "cylinder" ? ShapeKind::cylinder : ShapeKind::capsule;
    for (const char* key :
         box ? std::vector<const char*>{"edges_mm"} : std::vector<const char*>{"from_mm", "to_mm", "radius_mm"})
      if (o.has("kind") && !o.names(key)) o.fault(o.at(), tr("expected \"{}\" of a {}, got none", key, kind));
    s.from = three_mm(o, box ? "middle_mm" : "from_mm");
    s.to = three_mm(o, box ? "edges_mm" : "to_mm");
    s.turn = three_deg(o, "turn_deg");
    s.radius = mm(o, "radius_mm");
    return s;
  }

  void motor(const JsonObject& o) {
    Motor m;
    m.name = o.text("name");
    m.measure = o.text("kind") == "slide" ? Measure::length : Measure::angle;
    values(o, {m.measure}, m.limits, m.start);
    d.motors.push_back(std::move(m));
  }

  void coupling(const JsonObject& o) {
    Coupling c;
    c.coordinate = o.text("coordinate");
    c.offset = o.names("offset_mm") ? mm(o, "offset_mm") : deg(o, "offset_deg");
    for (const JsonObject& t : o.objects("terms")) {
      Coupling::Term term;
      term.of = t.text("of");
      int said = 0;
      const auto is = [&](const char* key, double unit) {
        if (!t.names(key)) return;
        ++said;
        term.ratio = one(t, key, Measure::ratio, unit, kMostRatio);
      };
      is("ratio", 1);
      is("ratio_mm_deg", kMillimetre / kDegree);
      is("ratio_deg_mm", kDegree / kMillimetre);
      if (said != 1)
        t.fault(t.at(),
                tr("expected one of \"ratio\", \"ratio_mm_deg\", \"ratio_deg_mm\", got {}", said ? "more" : "none"));
      c.terms.push_back(std::move(term));
    }
    d.couplings.push_back(std::move(c));
  }

  void actuator(const JsonObject& o) {
    Actuator a;
    a.name = o.text("name");
    a.coordinate = o.text("coordinate");
    const bool slide = o.names("at_0_mm") || o.names("at_1_mm");
    for (const char* key :
         slide ? std::vector<const char*>{"at_0_mm", "at_1_mm"} : std::vector<const char*>{"at_0_deg", "at_1_deg"})
      if (!o.names(key)) o.fault(o.at(), tr("expected \"{}\", got none", key));
    a.at_0 = slide ? mm(o, "at_0_mm") : deg(o, "at_0_deg");
    a.at_1 = slide ? mm(o, "at_1_mm") : deg(o, "at_1_deg");
    d.actuators.push_back(std::move(a));
  }

  void closure(const JsonObject& o) {
    LoopClosure c;
    c.name = o.text("name");
    c.directions = 0;
    for (const ClosureWord& w : kClosureWords)
      if (o.text("kind") == w.word) c.directions = w.directions;
    const std::vector<std::string> words = o.texts("directions");
    for (std::size_t i = 0; i < words.size(); ++i) {
      const auto found = std::find(std::begin(kDirectionWords), std::end(kDirectionWords), words[i]);
      if (found == std::end(kDirectionWords))
        o.fault(o.at("directions", i), tr("expected one of tx, ty, tz, rx, ry, rz, got \"{}\"", words[i]));
      else
        c.directions |= 1u << (found - std::begin(kDirectionWords));
    }
    if (o.names("kind") == o.names("directions"))
      o.fault(o.at(), tr("expected either \"kind\" or \"directions\", got {}", o.names("kind") ? "both" : "none"));
    c.a = end(o, "a");
    c.b = end(o, "b");
    d.closures.push_back(std::move(c));
  }

  void spring(const JsonObject& o) {
    d.springs.push_back({o.text("name"), end(o, "a"), end(o, "b"), o.number("stiffness_N_m"), o.number("damping_N_s_m"),
                         o.number("rest_mm") * kMillimetre});
  }

  std::vector<JsonObject>& list(const char* key) {
    return std::find_if(m_lists.begin(), m_lists.end(), [&](const auto& l) { return l.first == key; })->second;
  }

  /// Angles in degrees, slides in millimetres, and ratios of what to what.
  void check_units() {
    const std::vector<NamedCoordinate> all = coordinates_of(d);
    const auto slides = [&](const std::string& name) {
      return std::any_of(all.begin(), all.end(),
                         [&](const NamedCoordinate& c) { return c.name == name && c.measure == Measure::length; });
    };
    const auto refuse = [](const JsonObject& o, const char* key, const std::string& name, bool slide) {
      if (o.names(key))
        o.fault(key, tr("expected no \"{}\", as \"{}\" is {}, got one", key, name, slide ? "a slide" : "an angle"));
    };
    for (std::size_t i = 0; i < d.actuators.size(); ++i) {
      const bool slide = slides(d.actuators[i].coordinate);
      for (const char* key :
           slide ? std::vector<const char*>{"at_0_deg", "at_1_deg"} : std::vector<const char*>{"at_0_mm", "at_1_mm"})
        refuse(list("actuators")[i], key, d.actuators[i].coordinate, slide);
    }
    for (std::size_t i = 0; i < d.couplings.size(); ++i) {
      const Coupling& c = d.couplings[i];
      const bool slide = slides(c.coordinate);
      const JsonObject& o = list("couplings")[i];
      refuse(o, slide ? "offset_deg" : "offset_mm", c.coordinate, slide);
      const std::vector<JsonObject> terms = o.objects("terms");
      for (std::size_t k = 0; k < terms.size(); ++k) {
        const bool of_slide = slides(c.terms[k].of);
        const char* key = slide == of_slide ? "ratio" : slide ? "ratio_mm_deg" : "ratio_deg_mm";
        if (!terms[k].names(key))
          terms[k].fault(terms[k].at(),
                         tr("expected \"{}\", as \"{}\" is {} and \"{}\" {}, got another", key, c.coordinate,
                            slide ? "a slide" : "an angle", c.terms[k].of, of_slide ? "a slide" : "an angle"));
      }
    }
  }

  core::Location place_of(const MechanismFault& f) const {
    using Part = MechanismFault::Part;
    constexpr std::pair<Part, const char*> kLists[] = {{Part::link, "links"},         {Part::motor, "motors"},
                                                       {Part::coupling, "couplings"}, {Part::actuator, "actuators"},
                                                       {Part::frame, "frames"},       {Part::closure, "closures"},
                                                       {Part::spring, "springs"}};
    for (const auto& [part, key] : kLists) {
      if (part != f.part) continue;
      for (const auto& [name, objects] : m_lists)
        if (name == key && std::size_t(f.index) < objects.size()) {
          std::string field = f.field;
          for (const KeyOfField& k : kFieldKeys)
            if (field == k.field) field = k.key;
          const JsonObject& o = objects[std::size_t(f.index)];
          return f.item >= 0 ? o.at(field, std::size_t(f.item)) : o.at(field);
        }
    }
    if (f.part == Part::parameter) return m_file.at("parameters", std::size_t(f.index));
    return m_file.at(f.field);
  }

  const JsonObject& m_file;
  std::vector<core::Fault>& m_faults;
  MechanismDescription d;
  std::vector<std::pair<std::string, std::vector<JsonObject>>> m_lists;
};

std::vector<std::string> words_of_closures() {
  std::vector<std::string> words;
  for (const ClosureWord& w : kClosureWords) words.emplace_back(w.word);
  return words;
}

}  // namespace
}  // namespace mechanism_reading

using kinematics::MechanismDescription;
using mechanism_reading::MechanismReading;

std::vector<std::string> closure_words() { return mechanism_reading::words_of_closures(); }

MechanismDescription parse_mechanism(std::string_view text, const std::string& file, std::vector<core::Fault>& faults) {
  const JsonDocument document = parse_json(text, file, faults);
  return MechanismReading(JsonObject(document.root, mechanism_shape(), document.file, faults), faults).read();
}

bool is_robot_file(const std::filesystem::path& path) {
  if (path.extension() == ".urdf" || path.extension() == ".xacro") return true;
  std::error_code error;
  if (path.extension() == ".json" || !std::filesystem::is_regular_file(path, error)) return false;
  std::string begin(64u << 10, '\0');  // the first element is there
  std::ifstream file(path, std::ios::binary);
  file.read(begin.data(), std::streamsize(begin.size()));
  begin.resize(std::size_t(std::max<std::streamsize>(0, file.gcount())));
  const std::string root = core::xml_root(begin);
  return root == "robot" || root == "sdf" || root == "mujoco" || root == "mujocoinclude";
}

MechanismDescription read_mechanism(const std::filesystem::path& path, std::vector<core::Fault>& faults,
                                    const MemoryFiles* memory) {
  const std::string name = path.generic_string();
  const std::string* text = memory ? memory->text_of(path) : nullptr;
  if (text || !MemoryFiles::disk_too(memory) ? path.extension() == ".urdf" : is_robot_file(path)) {
    if (text) return read_urdf(*text, name, faults);
    try {
      return read_urdf(core::read_file(path, kMaxUrdfBytes), name, faults);
    } catch (const core::BadInput& bad) {
      tell(faults, bad.faults().front());
      return {};
    }
  }
  const JsonDocument document = load_json(path, faults, memory);
  return MechanismReading(JsonObject(document.root, mechanism_shape(), document.file, faults), faults).read();
}

MechanismDescription read_mechanism(const std::filesystem::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  MechanismDescription d = read_mechanism(path, faults, memory);
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return d;
}

std::vector<core::Fault> mechanism_warnings(const std::filesystem::path& path) {
  if (!is_robot_file(path)) return {};
  const std::string file = path.generic_string();
  std::vector<core::Fault> faults;
  const XmlElement root = parse_xml(core::read_file(path, kMaxUrdfBytes), file, faults);
  return faults.empty() ? urdf_warnings(root, file) : std::vector<core::Fault>();
}

}  // namespace trocar::scene
