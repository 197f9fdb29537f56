#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <trocar/core/text.hpp>
#include <trocar/kinematics/loops/close.hpp>
#include <trocar/scene/mechanisms/hinge_chain.hpp>
#include <trocar/scene/mechanisms/instrument_mechanism.hpp>
#include <trocar/scene/mechanisms/linkage_works.hpp>

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
  const kinematics::Pose& pose() const { return m_work.pose; }

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
  std::vector<kinematics::Pose> poses;
};

/// Do the jaws go as the handle does, with the same leverage all the way? Then nothing is to be computed that is not
/// without the linkage.
bool as_the_handle(const Ways& ways) {
  constexpr double kSame = 1e-6;  // of the way
  constexpr int last = interactions::kLinkageSteps;
  const double all = ways.opening[0] - ways.opening[last];
  for (int k = 0; k <= last; ++k) {
    const double aperture = (ways.opening[k] - ways.opening[last]) / all;
    if (std::fabs(aperture - (1 - double(k) / last)) > kSame || std::fabs(ways.slope[k] - all) > 10 * kSame * all)
      return false;
  }
  return true;
}

/// An angle as a file would have it, without what closing a loop leaves: to a billionth of a degree [rad].
double as_written(double angle) {
  return std::floor(angle * 180 / portable::pi * 1e9 + 0.5) / 1e9 * portable::pi / 180;
}

/// Empty, or what is wrong.
std::string find_ways(LedLinkage& led, Ways& ways) {
  for (int k = 0; k <= interactions::kLinkageSteps; ++k) {
    const double handle = double(k) / interactions::kLinkageSteps;
    const auto opening = led.opening(handle);
    ways.poses.push_back(led.pose());
    const auto slope = opening ? closing_slope(led, handle) : std::nullopt;
    if (!slope) return tr("one that at handle {:.2f} is {}", handle, led.why());
    ways.opening[k] = *opening;
    ways.slope[k] = *slope;
  }
  const double all = ways.opening[0] - ways.opening[interactions::kLinkageSteps];
  for (int k = 0; k <= interactions::kLinkageSteps; ++k)
    if (!(ways.slope[k] > kLeastSlope * all))
      return tr("one whose jaws do not close any more at handle {:.2f}", double(k) / interactions::kLinkageSteps);
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
    faults.push_back(
        {i.linkage.at, tr("expected a mechanism with an actuator '{}', got {}", i.handle, names_of(m.drives))});
    return;
  }
  if (upper < 0 || lower < 0) {
    faults.push_back({i.linkage.at, tr("expected a mechanism with frames {} and {}, got {}", first, second,
                                       names_of(m.frame_names))});
    return;
  }
  const bool parallel = i.parallel_gap > 0;
  LedLinkage led(m, drive, upper, lower, sling ? LedLinkage::along : parallel ? LedLinkage::gap : LedLinkage::angle);
  Ways ways;
  if (const std::string why = find_ways(led, ways); !why.empty()) {
    faults.push_back(
        {i.linkage.at, "expected a linkage that closes the jaws over the handle's whole range, got " + why});
    return;
  }
  constexpr int last = interactions::kLinkageSteps;
  if (!parallel && !sling && std::fabs(ways.opening[last]) > kNearlyShut) {
    faults.push_back({i.linkage.at, tr("expected jaws that meet when the handle is closed, got {:.1f} degrees "
                                       "between them",
                                       ways.opening[last] * 180 / portable::pi)});
    return;
  }
  tool.works = works_of(m, ways.poses, upper, lower, i.jaw_length);
  if (as_the_handle(ways) && (!parallel || std::fabs(ways.opening[0] - ways.opening[last] - i.parallel_gap) < 1e-9)) {
    if (!parallel) tool.opening = as_written(ways.opening[0] - ways.opening[last]);
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
  const std::string why = take_hinges(kinematics::build(*w.mechanism.description), i.jaw_length, tool.bends);
  if (why.empty()) return;
  faults.push_back(
      {w.mechanism.at,
       tr("expected hinges between the link 'shaft' and the frame 'tip', along the shaft's axis and square to "
          "it, at most {} joints, got {} (an arm that carries an instrument from outside belongs to the 'arms' "
          "of a room)",
          kinematics::kMaxJoints, why)});
}

}  // namespace trocar::scene
