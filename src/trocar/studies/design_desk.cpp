#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <trocar/studies/design_desk.hpp>
#include <trocar/studies/handles.hpp>

namespace trocar::studies {

using namespace kinematics;

namespace {

constexpr double kAbout = 0.5;              // share of a length or a ratio by which it can be turned without bounds
constexpr double kAngle = 0.5235987755983;  // an angle, 30 degrees [rad]
constexpr double kFarLimit = 1e5;           // limits beyond this are none
constexpr std::size_t kMostSteps = 500;     // of undo
constexpr ClearanceOptions kQuickSweep{DesignDesk::kPathSteps, 200, false, false, {}};

DesignDesk::Dial dial_of(const Parameter& p, int number) {
  if (p.low != 0 || p.high != 0) return {number, p.low, p.high, true};
  double by = p.measure == Measure::angle ? kAngle : kAbout * std::fabs(p.value);
  if (by == 0) by = p.measure == Measure::length ? 1e-3 : 1;
  return {number, p.value - by, p.value + by, false};
}

}  // namespace

DesignDesk::DesignDesk(const MechanismDescription& description)
    : m_start(build(description)),
      m_now(m_start),
      m_values(m_start.parameter_values),
      m_kept(m_values),
      m_u(m_start.start_u()),
      m_good(m_u),
      m_work(m_start),
      m_links(m_start, {}) {
  for (int i = 0; i < m_start.named_parameters; ++i) m_dials.push_back(dial_of(m_start.parameters[std::size_t(i)], i));
  find_leads();
  for (const Lead& l : m_leads) {
    const double way = l.at_1 - l.at_0;
    m_handles.push_back(way != 0 ? std::clamp((m_u[std::size_t(l.independent)] - l.at_0) / way, 0.0, 1.0) : 0);
  }
  stand();
  m_drawn = m_links.drawn(m_now, pose());
}

void DesignDesk::find_leads() {
  m_leads.clear();
  for (const Drive& d : m_now.drives) m_leads.push_back({d.name, d.independent, d.at_0, d.at_1});
  if (!m_leads.empty() || !m_now.closures.empty()) return;
  for (int u = 0; u < m_now.u_count(); ++u) {
    const auto q = std::size_t(m_now.independent[std::size_t(u)]);
    if (std::fabs(m_now.low[q]) < kFarLimit && std::fabs(m_now.high[q]) < kFarLimit)
      m_leads.push_back({m_now.coordinates[q], u, m_now.low[q], m_now.high[q]});
  }
}

void DesignDesk::set_leads(std::span<const double> handles, std::span<double> u) const {
  for (std::size_t i = 0; i < m_leads.size(); ++i)
    u[std::size_t(m_leads[i].independent)] = m_leads[i].at_0 + handles[i] * (m_leads[i].at_1 - m_leads[i].at_0);
}

/// With the dimensions and handles as they are, from the last pose that closed.
void DesignDesk::stand() {
  m_now.assign(m_values);
  find_leads();  // the ends of a drive's way are dimensions, too
  m_u = m_good;
  set_leads(m_handles, m_u);
  hold_for_study(m_now, m_work);
  m_report = close(m_now, m_u, m_work);
  if (m_report.closed()) m_good = m_u;
}

void DesignDesk::turn(const Dial& dial, double value) {
  m_values[std::size_t(dial.parameter)] = std::clamp(value, dial.low, dial.high);
  m_looked = false;
  stand();
}

void DesignDesk::lead(std::size_t lead, double handle) {
  m_handles[lead] = std::clamp(handle, 0.0, 1.0);
  stand();
}

bool DesignDesk::changed() const { return m_values != m_start.parameter_values; }

void DesignDesk::keep() {
  if (m_values == m_kept) return;
  m_undone_to.push_back(m_kept);
  if (m_undone_to.size() > kMostSteps) m_undone_to.erase(m_undone_to.begin());
  m_redone_to.clear();
  m_kept = m_values;
}

void DesignDesk::undo() {
  keep();
  if (m_undone_to.empty()) return;
  m_redone_to.push_back(m_values);
  m_values = m_kept = m_undone_to.back();
  m_undone_to.pop_back();
  m_looked = false;
  stand();
}

void DesignDesk::redo() {
  if (m_redone_to.empty()) return;
  m_undone_to.push_back(m_values);
  m_values = m_kept = m_redone_to.back();
  m_redone_to.pop_back();
  m_looked = false;
  stand();
}

void DesignDesk::reset() { put(m_start.parameter_values); }

void DesignDesk::put(std::span<const double> values) {
  keep();
  m_values.assign(values.begin(), values.end());
  keep();
  m_looked = false;
  stand();
}

const std::optional<ClearanceReport>& DesignDesk::clearance() const {
  if (m_looked) return m_clearance;
  m_looked = true;
  m_clearance.reset();
  if (m_leads.empty()) return m_clearance;
  try {
    ClearanceOptions sweep = kQuickSweep;
    sweep.drawn = m_drawn;
    m_clearance = clearance_over_motion(m_now, sweep);
  } catch (const std::invalid_argument&) {
    // its start does not close: words() says so
  }
  return m_clearance;
}

double DesignDesk::gap_now(const PairClearance& pair) const {
  const LinkPair* links = m_links.of(pair.first, pair.second);
  return links ? m_links.gap(*links, m_now, pose(), m_drawn) : 1e9;
}

std::vector<Vec3d> DesignDesk::path(int frame) const {
  std::vector<Vec3d> path;
  if (m_leads.empty() || frame < 0) return path;
  LoopWork work(m_now);
  std::vector<double> u = m_good, handles = m_handles;
  hold_for_study(m_now, work);
  const auto pass = [&](double handle) {
    std::vector<double> trial = u;
    handles[0] = handle;
    set_leads(handles, trial);
    if (!close(m_now, trial, work).closed()) return false;
    u = trial;
    return true;
  };
  // From where it stands to one end, then all the way back: never far from a pose that closed.
  for (int i = int(m_handles[0] * kPathSteps); i >= 0; --i)
    if (!pass(double(i) / kPathSteps)) break;
  for (int i = 0; i <= kPathSteps; ++i)
    if (pass(double(i) / kPathSteps)) path.push_back(place(m_now.frames[std::size_t(frame)], work.pose).p);
  return path;
}

}  // namespace trocar::studies
