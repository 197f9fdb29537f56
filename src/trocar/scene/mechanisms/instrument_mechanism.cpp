#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <trocar/kinematics/loops/close.hpp>
#include <trocar/scene/mechanisms/instrument_mechanism.hpp>

namespace trocar::scene {
namespace {

using kinematics::Mechanism;

constexpr double kNearlyShut = 0.02;  // [rad] between closed jaws
constexpr double kSlopeStep = 1e-4;   // of the handle's way
constexpr double kLeastSlope = 1e-3;  // of the mean: less, and the linkage is as good as at a dead point

template <class List>
std::string names_of(const List& list) {
  std::string out;
  for (const auto& entry : list) {
    if constexpr (requires { entry.name; })
      out += (out.empty() ? "" : ", ") + entry.name;
    else
      out += (out.empty() ? "" : ", ") + entry;
  }
  return out.empty() ? "none" : out;
}

/// A linkage, led by its handle.
class LedLinkage {
 public:
  enum Way {
    angle,
    gap,
    along
  };  ///< what opens: jaws that turn or stay parallel, a clamp that is drawn along the axis

  LedLinkage(const Mechanism& m, int drive, int upper, int lower, Way way)
      : m_m(m),
        m_drive(m.drives[std::size_t(drive)]),
        m_upper(upper),
        m_lower(lower),
        m_way(way),
        m_work(m),
        m_u(m.start_u()) {
    kinematics::hold_drives(m, m_work);
    const kinematics::LoopReport report = kinematics::close(m, m_u, m_work);
    if (report.closed())
      m_branch = kinematics::branch_at(m, m_u, m_work);
    else
      m_why = words(m, report);
  }
  const std::string& why() const { return m_why; }

  /// Angle between the jaws [rad] or their gap [m]; none, and why() says it, where it does not get there.
  std::optional<double> opening(double handle) {
    if (!m_why.empty()) return {};
    const kinematics::MoveReport moved =
        kinematics::move(m_m, m_u, {{m_drive.independent, m_drive.value(handle)}}, m_branch, m_work);
    if (!moved.arrived()) {
      m_why = words(m_m, moved);
      return {};
    }
    const kinematics::Frame a = place(m_m.frames[std::size_t(m_upper)], m_work.pose);
    const kinematics::Frame b = place(m_m.frames[std::size_t(m_lower)], m_work.pose);
    if (m_way == gap) return a.p.x - b.p.x;
    if (m_way == along) return b.p.z - a.p.z;
    return turned(a) - turned(b);
  }

 private:
  /// Of a jaw's axis, -z, towards x.
  static double turned(const kinematics::Frame& f) {
    const Vec3d axis = -f.r.column(2);
    return portable::atan2(axis.x, -axis.z);
  }

  const Mechanism& m_m;
  const kinematics::Drive& m_drive;
  int m_upper, m_lower;
  Way m_way;
  kinematics::LoopWork m_work;
  kinematics::Branch m_branch;
  std::vector<double> m_u;
  std::string m_why;
};

/// How fast jaws close at a place of the handle: by differences of second order, to one side at the ends.
std::optional<double> closing_slope(LedLinkage& led, double handle) {
  constexpr double h = kSlopeStep;
  const double way = handle < h ? h : handle > 1 - h ? -h : 0;
  if (way == 0) {
    const auto before = led.opening(handle - h), after = led.opening(handle + h);
    if (!before || !after) return {};
    return (*before - *after) / (2 * h);
  }
  const auto a = led.opening(handle), b = led.opening(handle + way), c = led.opening(handle + 2 * way);
  if (!a || !b || !c) return {};
  return (3 * *a - 4 * *b + *c) / (2 * way);
}

struct Ways {
  double opening[interactions::kLinkageSteps + 1] = {}, slope[interactions::kLinkageSteps + 1] = {};
};

/// Empty, or what is wrong.
std::string find_ways(LedLinkage& led, Ways& ways) {
  for (int k = 0; k <= interactions::kLinkageSteps; ++k) {
    const double handle = double(k) / interactions::kLinkageSteps;
    const auto opening = led.opening(handle);
    const auto slope = opening ? closing_slope(led, handle) : std::nullopt;
    if (!slope) return fmt::format("one that at handle {:.2f} is {}", handle, led.why());
    ways.opening[k] = *opening;
    ways.slope[k] = *slope;
  }
  const double all = ways.opening[0] - ways.opening[interactions::kLinkageSteps];
  for (int k = 0; k <= interactions::kLinkageSteps; ++k)
    if (!(ways.slope[k] > kLeastSlope * all))
      return fmt::format("one whose jaws do not close any more at handle {:.2f}",
                         double(k) / interactions::kLinkageSteps);
  return "";
}

/// The hinge of a body of the chain; none, and what is wrong.
std::optional<kinematics::Hinge> hinge_of(const Mechanism& m, int body, std::vector<int>& joints, std::string& why) {
  const kinematics::Body& b = m.bodies[std::size_t(body)];
  const kinematics::Frame& place = m.places[std::size_t(body)];
  const double off = std::fabs(place.p.x) + std::fabs(place.p.y);
  const double turn = length(kinematics::turn_between(Mat3d::identity(), place.r));
  kinematics::Hinge hinge;
  hinge.before = -place.p.z;
  if (off > 1e-9 || turn > 1e-9 || hinge.before < -1e-12) {
    why = "one that is turned or set aside";
    return {};
  }
  hinge.joint = -1;
  if (b.motion == kinematics::Motion::none) return hinge;
  const double about_x = b.axis.x, about_y = b.axis.y;
  if (b.motion != kinematics::Motion::turn || std::fabs(about_x) + std::fabs(about_y) < 1 - 1e-9 ||
      std::fabs(about_x * about_y) > 1e-9) {
    why = "one with another joint";
    return {};
  }
  hinge.across = std::fabs(about_y) > 0.5 ? 1 : 0;
  const auto from = m.expand_start[std::size_t(b.coordinate)], to = m.expand_start[std::size_t(b.coordinate) + 1];
  if (to != from + 1 || m.offset[std::size_t(b.coordinate)] != 0) {
    why = "one whose hinges follow several joints, or none";
    return {};
  }
  const Mechanism::Entry& entry = m.expand[std::size_t(from)];
  const auto known = std::find(joints.begin(), joints.end(), entry.u);
  hinge.joint = std::int32_t(known - joints.begin());
  if (known == joints.end()) joints.push_back(entry.u);
  hinge.share = entry.ratio * (hinge.across ? about_y : about_x);
  return hinge;
}

/// From the tip's body back to the shaft's, turned round; empty where they are not in one line.
std::vector<int> bodies_between(const Mechanism& m, int shaft, int tip) {
  std::vector<int> out;
  for (int body = tip; body != shaft; body = m.bodies[std::size_t(body)].parent) {
    if (body <= 0) return {};
    out.insert(out.begin(), body);
  }
  return out;
}

/// Empty, or what is wrong.
std::string take_chain(const Mechanism& m, double jaw_length, kinematics::Articulation& out) {
  const int link = m.link("shaft"), frame = m.frame("tip");
  if (link < 0) return "links " + names_of(m.links);
  if (frame < 0) return "frames " + names_of(m.frame_names);
  const kinematics::BodyFrame& tip = m.frames[std::size_t(frame)];
  std::vector<int> joints;
  std::string why;
  double carried = 0;  // along bodies that do not turn
  for (const int body : bodies_between(m, m.link_body[std::size_t(link)], tip.body)) {
    std::optional<kinematics::Hinge> hinge = hinge_of(m, body, joints, why);
    if (!hinge) return why;
    carried += hinge->before;
    if (hinge->joint < 0) continue;
    if (out.hinges == kinematics::kMaxHinges) return fmt::format("more than {} hinges", kinematics::kMaxHinges);
    hinge->before = carried;
    carried = 0;
    out.hinge[out.hinges++] = *hinge;
  }
  if (joints.empty()) return "one without";
  if (int(joints.size()) > kinematics::kMaxJoints) return fmt::format("{} joints", joints.size());
  out.joints = std::int32_t(joints.size());
  out.after = carried - tip.local.p.z - jaw_length;
  if (out.after < -1e-9)
    return fmt::format("a tip {:.1f} mm after the last hinge, nearer than jaws of {:.1f} mm", -1000 * tip.local.p.z,
                       1000 * jaw_length);
  out.after = std::max(0.0, out.after);
  if (out.links() > kinematics::kMaxLinks)
    return fmt::format("{} straight pieces, more than {}", out.links(), kinematics::kMaxLinks);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto q = std::size_t(m.independent[std::size_t(joints[j])]);
    if (!std::isfinite(m.low[q]) || !std::isfinite(m.high[q]))
      return fmt::format("'{}' without limits", m.coordinates[q]);
    out.low[j] = m.low[q];
    out.high[j] = m.high[q];
  }
  return "";
}

}  // namespace

void take_linkage(const Instrument& i, interactions::ToolModel& tool, std::vector<core::Fault>& faults) {
  if (!i.linkage.description) return;
  const Mechanism m = kinematics::build(*i.linkage.description);
  const int drive = m.drive(i.handle);
  const bool sling = i.can().sling;
  const char *first = sling ? "clamp" : "tip_upper", *second = sling ? "mouth" : "tip_lower";
  const int upper = m.frame(first), lower = m.frame(second);
  if (drive < 0) {
    faults.push_back({i.linkage.at,
                      fmt::format("expected a mechanism with an actuator '{}', got {}", i.handle, names_of(m.drives))});
    return;
  }
  if (upper < 0 || lower < 0) {
    faults.push_back({i.linkage.at, fmt::format("expected a mechanism with frames {} and {}, got {}", first, second,
                                                names_of(m.frame_names))});
    return;
  }
  const bool parallel = i.parallel_gap > 0;
  LedLinkage led(m, drive, upper, lower, sling ? LedLinkage::along : parallel ? LedLinkage::gap : LedLinkage::angle);
  Ways ways;
  if (const std::string why = find_ways(led, ways); !why.empty()) {
    faults.push_back({i.linkage.at, "expected a linkage that closes the jaws all along the handle's way, got " + why});
    return;
  }
  constexpr int last = interactions::kLinkageSteps;
  if (!parallel && !sling && std::fabs(ways.opening[last]) > kNearlyShut) {
    faults.push_back({i.linkage.at, fmt::format("expected jaws that meet when the handle is closed, got {:.1f} degrees "
                                                "between them",
                                                ways.opening[last] * 180 / portable::pi)});
    return;
  }
  tool.linkage.there = true;
  for (int k = 0; k <= last; ++k) {
    tool.linkage.aperture[k] = (ways.opening[k] - ways.opening[last]) / (ways.opening[0] - ways.opening[last]);
    tool.linkage.leverage[k] = ways.slope[last] / ways.slope[k];  // virtual work, relative to the closed jaws
  }
  if (sling)
    tool.opening = 0;
  else if (!parallel)
    tool.opening = ways.opening[0] - ways.opening[last];
}

void take_wrist(const Instrument& i, interactions::ToolModel& tool, std::vector<core::Fault>& faults) {
  const WristSetting& w = i.wrist;
  if (!w.there) return;
  if (w.mechanism.file.empty()) {
    tool.bends = kinematics::wrist(w.between, w.after, w.pitch, w.yaw);
    return;
  }
  if (!w.mechanism.description) return;  // the reader has told
  const std::string why = take_chain(kinematics::build(*w.mechanism.description), i.jaw_length, tool.bends);
  if (why.empty()) return;
  tool.bends = {};
  faults.push_back({w.mechanism.at, fmt::format("expected hinges about x and y, one after the other along -z, between "
                                                "the link 'shaft' and the frame 'tip', at most {} joints; got {}",
                                                kinematics::kMaxJoints, why)});
}

}  // namespace trocar::scene
