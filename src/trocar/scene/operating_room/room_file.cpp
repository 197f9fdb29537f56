#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/numerics/portable.hpp>
#include <trocar/scene/files/library.hpp>
#include <trocar/scene/files/reader.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>
#include <trocar/scene/operating_room/room_file.hpp>
#include <trocar/scene/operating_room/room_keys.hpp>

namespace trocar::scene {

int Room::port(const std::string& port_name) const {
  for (std::size_t k = 0; k < ports.size(); ++k)
    if (ports[k].name == port_name) return int(k);
  return -1;
}

double Programme::length() const {
  double last = 0;
  for (const Move& m : moves)
    if (!m.poses.empty()) last = std::max(last, m.poses.back().at);
  if (!tilts.empty()) last = std::max(last, tilts.back().at);
  return last;
}

const char* word_of(StaffRole role) {
  constexpr const char* kWords[] = {"surgeon", "assistant", "camera holder", "scrub nurse", "anaesthetist"};
  return kWords[std::size_t(role)];
}

namespace {

constexpr double kMm = 1e-3, kDeg = portable::pi / 180;

class RoomReading {
 public:
  RoomReading(const JsonObject& file, std::vector<core::Fault>& faults) : m_file(file), m_faults(faults) {}

  Room read(const std::filesystem::path* folder, const Library* library, const MemoryFiles* memory) {
    room.name = m_file.text("name");
    room.title = m_file.text("title");
    room.scene = m_file.text("ports_of");
    room.margin = kMm * m_file.number("margin_mm", 5);
    for (const JsonObject& o : m_file.objects("patient")) patient(o);
    for (const JsonObject& o : m_file.objects("table")) table(o);
    if (folder && m_file.has("ports_of")) take_scene(*folder, *library, memory);
    for (const JsonObject& o : m_file.objects("ports")) port(o);
    for (const JsonObject& o : m_file.objects("staff")) person(o);
    for (const JsonObject& o : m_file.objects("instruments")) instrument(o);
    for (const JsonObject& o : m_file.objects("monitors")) monitor(o);
    for (const JsonObject& o : m_file.objects("arms")) {
      arm(o);
      if (folder && o.has("mechanism")) take_mechanism(o, room.arms.back(), *folder, *library, memory);
    }
    for (const JsonObject& o : m_file.objects("targets")) target(o);
    return std::move(room);
  }

 private:
  void patient(const JsonObject& o) {
    geometry::FigureSizes& p = room.patient;
    p.stature = kMm * o.number("stature_mm", 1e3 * p.stature);
    p.breadth = kMm * o.number("breadth_mm", 1e3 * p.breadth);
    p.depth = kMm * o.number("depth_mm", 1e3 * p.depth);
    p.rise = kMm * o.number("rise_mm", 1e3 * p.rise);
    p.legs_apart = kDeg * o.number("legs_apart_deg");
    p.arms_out = o.flag("arms_out");
  }
  void table(const JsonObject& o) {
    RoomTable& t = room.table;
    t.width = kMm * o.number("width_mm", 540);
    t.thickness = kMm * o.number("thickness_mm", 70);
    t.height = kMm * o.number("height_mm", 800);
    t.head_down_most = kDeg * o.number("head_down_most_deg", 30);
    t.head_up_most = kDeg * o.number("head_up_most_deg", 30);
    t.side_most = kDeg * o.number("side_most_deg", 20);
    t.drop = kMm * o.number("axes_below_mm", 250);
    t.fastest = kDeg * o.number("fastest_deg_s", 3);
    t.tilt = {kDeg * o.number("head_down_deg"), kDeg * o.number("left_down_deg")};
    within(o, "head_down_deg", t.tilt.head_down, -t.head_up_most, t.head_down_most);
    within(o, "left_down_deg", t.tilt.left_down, -t.side_most, t.side_most);
  }
  static void within(const JsonObject& o, const char* key, double value, double low, double high) {
    constexpr double kSlack = 1e-9;
    if (value < low - kSlack || value > high + kSlack)
      o.fault(key, tr("expected an angle in the table's range, {:.4g} to {:.4g}, got {:.4g}", low / kDeg, high / kDeg,
                      value / kDeg));
  }
  template <class Item>
  std::string named(const JsonObject& o, const std::vector<Item>& others, const char* what) {
    std::string name = o.text("name");
    for (const Item& other : others)
      if (!name.empty() && other.name == name)
        o.fault("name", tr("expected a name that no other {} has, got \"{}\" again", what, name));
    return name;
  }
  void port(const JsonObject& o) {
    RoomPort p{named(o, room.ports, "port"), kMm * o.vec3("at_mm"), kMm * o.number("diameter_mm", 5), o.at()};
    room.ports.push_back(std::move(p));
  }
  /// Where nothing is known of the scene, any port may be one of its.
  void check_port(const JsonObject& o, const std::string& name) {
    if (name.empty() || room.port(name) >= 0 || (!m_scene_known && !room.scene.empty())) return;
    std::vector<std::string> known;
    for (const RoomPort& p : room.ports) known.push_back(p.name);
    o.fault("port", unknown_name("port", name, known));
  }
  void instrument(const JsonObject& o) {
    RoomInstrument i;
    i.name = named(o, room.instruments, "instrument");
    i.port = o.text("port");
    i.held_by = o.text("held_by");
    i.tip = kMm * o.vec3("tip_mm");
    i.length = kMm * o.number("length_mm", 310);
    i.radius = kMm * o.number("diameter_mm", 5) / 2;
    i.camera = o.flag("camera");
    i.at = o.at();
    check_port(o, i.port);
    std::vector<std::string> people;
    for (const RoomPerson& p : room.staff) people.push_back(p.name);
    if (!i.held_by.empty() && std::find(people.begin(), people.end(), i.held_by) == people.end())
      o.fault("held_by", unknown_name("person", i.held_by, people));
    if (const int k = room.port(i.port); k >= 0 && o.has("tip_mm")) {
      const double inside = length(i.tip - room.ports[std::size_t(k)].position);
      if (!(inside > 1e-3) || inside > i.length - 0.02)
        o.fault("tip_mm", tr("expected a tip 1 mm to {:.0f} mm from its port, got {:.1f}", 1e3 * (i.length - 0.02),
                             1e3 * inside));
    }
    room.instruments.push_back(std::move(i));
  }
  void person(const JsonObject& o) {
    RoomPerson p;
    p.name = named(o, room.staff, "person");
    const std::vector<std::string> words = staff_words();
    const auto role = std::find(words.begin(), words.end(), o.text("role"));
    if (role != words.end()) p.role = StaffRole(role - words.begin());
    const std::vector<double> at = o.numbers("at_mm");
    if (at.size() == 2) p.x = kMm * at[0], p.y = kMm * at[1];
    p.step = kMm * o.number("step_mm");
    p.stature = kMm * o.number("stature_mm", 1750);
    p.reach = kMm * o.number("reach_mm", 720);
    p.at = o.at();
    room.staff.push_back(std::move(p));
  }
  void monitor(const JsonObject& o) {
    room.monitors.push_back(
        {named(o, room.monitors, "monitor"), kMm * o.vec3("at_mm"), kMm * o.number("diagonal_mm", 660), o.at()});
  }
  void arm(const JsonObject& o) {
    RoomArm a;
    a.name = named(o, room.arms, "arm");
    a.file = o.text("mechanism");
    a.port = o.text("port");
    a.on_table = o.text("on") == "table";
    a.base = o.vec3("base");
    a.out = o.vec3("out");
    const std::vector<double> at = o.numbers("stand_mm");
    if (at.size() == 2) a.x = kMm * at[0], a.y = kMm * at[1];
    a.tip = o.text("tip", "tip");
    a.shaft = o.text("shaft", "shaft");
    a.fastest_turn = kDeg * o.number("fastest_deg_s", 2 / kDeg);
    a.set_up = kMm * o.number("set_up_mm", 1000);
    a.fastest_slide = kMm * o.number("fastest_mm_s", 200);
    a.at = o.at();
    a.file_at = o.at("mechanism");
    check_port(o, a.port);
    const auto parallel = [](Vec3d u, Vec3d v) { return length(cross(u, v)) <= 1e-3 * length(u) * length(v); };
    if (o.has("base") && !(length(a.base) > 0)) o.fault("base", "expected a direction, got zero");
    if (o.has("out") && !(length(a.out) > 0))
      o.fault("out", "expected a direction, got zero");
    else if (o.has("out") && o.has("base") && parallel(a.out, a.base))
      o.fault("out", "expected a direction beside that of \"base\", got the same line");
    for (const RoomArm& other : room.arms)
      if (!a.port.empty() && other.port == a.port)
        o.fault("port", tr("expected an unused port, got that of \"{}\"", other.name));
    room.arms.push_back(std::move(a));
  }
  void target(const JsonObject& o) {
    RoomTarget t{named(o, room.targets, "target"), kMm * o.vec3("low_mm"), kMm * o.vec3("high_mm"), o.at()};
    if (o.has("low_mm") && o.has("high_mm") && !(t.low.x < t.high.x && t.low.y < t.high.y && t.low.z < t.high.z))
      o.fault("high_mm", "expected a corner beyond \"low_mm\" along every axis, got another");
    room.targets.push_back(std::move(t));
  }

  /// A file that this one names, if it may.
  bool allowed(const core::Location& at, const std::string& name, const std::filesystem::path& path,
               const Library& library, const MemoryFiles* memory) {
    if (!MemoryFiles::disk_too(memory) || library.holds(path)) return true;
    tell(m_faults, {at, library.refusal(name)});
    return false;
  }
  void take_scene(const std::filesystem::path& folder, const Library& library, const MemoryFiles* memory) {
    const std::filesystem::path path = (folder / room.scene).lexically_normal();
    if (!allowed(m_file.at("ports_of"), room.scene, path, library, memory)) return;
    try {
      for (const Port& p : read_scene(path, memory).ports) room.ports.push_back({p.name, p.position, p.diameter, p.at});
      m_scene_known = true;
    } catch (const core::BadInput& bad) {
      for (const core::Fault& f : bad.faults()) tell(m_faults, f);
    }
  }
  void take_mechanism(const JsonObject& o, RoomArm& a, const std::filesystem::path& folder, const Library& library,
                      const MemoryFiles* memory) {
    const std::filesystem::path path = (folder / a.file).lexically_normal();
    if (!allowed(a.file_at, a.file, path, library, memory)) return;
    const std::size_t before = m_faults.size();
    a.mechanism = read_mechanism(path, m_faults, memory);
    if (m_faults.size() > before) return;
    std::vector<std::string> frames;
    for (const kinematics::NamedFrame& f : a.mechanism.frames) frames.push_back(f.name);
    for (const auto& [key, name] : {std::pair("tip", a.tip), std::pair("shaft", a.shaft)})
      if (std::find(frames.begin(), frames.end(), name) == frames.end())
        o.fault(o.names(key) ? key : "mechanism", unknown_name("frame of the mechanism", name, frames));
  }

  const JsonObject& m_file;
  std::vector<core::Fault>& m_faults;
  Room room;
  bool m_scene_known = false;
};

class ProgrammeReading {
 public:
  ProgrammeReading(const JsonObject& file, const Room* room) : m_file(file), m_room(room) {}

  Programme read() {
    programme.name = m_file.text("name");
    programme.title = m_file.text("title");
    for (const JsonObject& o : m_file.objects("moves")) move(o);
    for (const JsonObject& o : m_file.objects("table")) tilt(o);
    return std::move(programme);
  }

 private:
  void later(const JsonObject& o, double at, double before, bool first) {
    if (!first && !(at > before))
      o.fault("at_s", tr("expected more than {:.4g}, the time before, got {:.4g}", before, at));
  }
  void move(const JsonObject& o) {
    Programme::Move m{o.text("arm"), {}, o.at()};
    if (m_room && !m.arm.empty()) {
      std::vector<std::string> known;
      for (const RoomArm& a : m_room->arms) known.push_back(a.name);
      if (std::find(known.begin(), known.end(), m.arm) == known.end())
        o.fault("arm", unknown_name("arm", m.arm, known));
    }
    for (const Programme::Move& other : programme.moves)
      if (!m.arm.empty() && other.arm == m.arm) o.fault("arm", tr("expected every arm once, got \"{}\" again", m.arm));
    for (const JsonObject& p : o.objects("poses")) {
      Programme::Pose pose;
      pose.at = p.number("at_s");
      pose.tip = kMm * p.vec3("tip_mm");
      pose.aims = p.flag("aims");
      pose.towards = p.vec3("towards");
      pose.roll = kDeg * p.number("roll_deg");
      if (!pose.aims && (p.names("towards") || p.names("roll_deg")))
        p.fault(p.names("towards") ? "towards" : "roll_deg", "expected \"aims\": true beside it, got none");
      later(p, pose.at, m.poses.empty() ? 0 : m.poses.back().at, m.poses.empty());
      m.poses.push_back(pose);
    }
    programme.moves.push_back(std::move(m));
  }
  void tilt(const JsonObject& o) {
    const Programme::Tilt t{o.number("at_s"), {kDeg * o.number("head_down_deg"), kDeg * o.number("left_down_deg")}};
    later(o, t.at, programme.tilts.empty() ? 0 : programme.tilts.back().at, programme.tilts.empty());
    programme.tilts.push_back(t);
  }

  const JsonObject& m_file;
  const Room* m_room;
  Programme programme;
};

}  // namespace

Room parse_room(std::string_view text, const std::string& file, std::vector<core::Fault>& faults) {
  const JsonDocument document = parse_json(text, file, faults);
  Room room = RoomReading(JsonObject(document.root, room_shape(), document.file, faults), faults)
                  .read(nullptr, nullptr, nullptr);
  room.file = file;
  return room;
}

Room read_room(const std::filesystem::path& path, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  const JsonDocument document = load_json(path, faults, memory);
  const std::filesystem::path folder = path.parent_path();
  const Library library(path);
  Room room = RoomReading(JsonObject(document.root, room_shape(), document.file, faults), faults)
                  .read(&folder, &library, memory);
  room.file = path.generic_string();
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return room;
}

Programme parse_programme(std::string_view text, const std::string& file, const Room* room,
                          std::vector<core::Fault>& faults) {
  const JsonDocument document = parse_json(text, file, faults);
  Programme p = ProgrammeReading(JsonObject(document.root, programme_shape(), document.file, faults), room).read();
  p.file = file;
  return p;
}

Programme read_programme(const std::filesystem::path& path, const Room& room, const MemoryFiles* memory) {
  std::vector<core::Fault> faults;
  const JsonDocument document = load_json(path, faults, memory);
  Programme p = ProgrammeReading(JsonObject(document.root, programme_shape(), document.file, faults), &room).read();
  p.file = path.generic_string();
  if (!faults.empty()) throw core::BadInput(std::move(faults));
  return p;
}

}  // namespace trocar::scene
