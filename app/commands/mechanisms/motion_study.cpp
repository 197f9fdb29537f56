#include "commands/mechanisms/motion_study.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/files.hpp>
#include <trocar/core/json.hpp>
#include <trocar/core/text.hpp>
#include <trocar/kinematics/dynamics/dynamics.hpp>

#include "commands/command.hpp"
#include "commands/mechanisms/coordinate_units.hpp"

namespace trocar::app {

using namespace kinematics;

namespace {

constexpr double kMostSteps = 1e6;

/// The course of a motion, a line a step.
class Table {
 public:
  explicit Table(const Mechanism& mechanism) : m(mechanism) {
    m_text = "t_s";
    for (int q = 0; q < m.q_count(); ++q) m_text += fmt::format(",{}_{}", m.coordinates[std::size_t(q)], unit_of(m, q));
    m_text += ",kinetic_J,potential_J\n";
  }
  void add(double at, const Pose& pose, const Energy& energy) {
    m_text += fmt::format("{:.6g}", at);
    for (int q = 0; q < m.q_count(); ++q) m_text += fmt::format(",{:.9g}", in_file(m, q, pose.q[std::size_t(q)]));
    m_text += fmt::format(",{:.9g},{:.9g}\n", energy.kinetic, energy.potential);
  }
  void write(const std::string& file) const {
    if (const std::string fault = core::write_file(file, m_text.data(), m_text.size()); !fault.empty())
      throw core::EnvironmentLacks(tr("{} cannot be written: {}", file, fault));
  }

 private:
  const Mechanism& m;
  std::string m_text;
};

struct Course {
  MotionStatus status = MotionStatus::good;
  int steps = 0;
  double at = 0;      ///< how far it got [s]
  Energy begin, end;  ///< [J]
  double off = 0;     ///< largest change of the total energy [J]
  double most_kinetic = 0;
};

Course run(const Mechanism& m, MotionState& s, DynamicsWork& work, const MotionChoice& choice, Table* table) {
  Course c;
  c.status = project(m, s, work);
  const std::vector<double> torques(std::size_t(m.u_count()), 0.0);
  const int steps = std::max(1, int(std::lround(1e3 * choice.seconds / choice.step_ms)));
  const double dt = choice.seconds / steps;
  for (int k = 0; c.status == MotionStatus::good; ++k) {
    c.end = energy(m, s, work);
    if (k == 0) c.begin = c.end;
    c.off = std::max(c.off, std::fabs(c.end.total() - c.begin.total()));
    c.most_kinetic = std::max(c.most_kinetic, c.end.kinetic);
    if (table) table->add(c.at, work.pose, c.end);
    if (k == steps) break;
    c.status = step(m, torques, dt, s, work);
    if (c.status != MotionStatus::good) break;
    ++c.steps;
    c.at = (k + 1) * dt;
  }
  return c;
}

}  // namespace

int show_motion(const Mechanism& m, std::vector<double> u, const MotionChoice& choice, bool json) {
  if (1e3 * choice.seconds > kMostSteps * choice.step_ms)
    throw core::BadInput({{{"--step-ms", 0, 0}, tr("expected at most {} steps, got more", int(kMostSteps))}});
  MotionState s{std::move(u), std::vector<double>(std::size_t(m.u_count()), 0.0)};
  DynamicsWork work(m);
  Table table(m);
  const Course c = run(m, s, work, choice, choice.data.empty() ? nullptr : &table);
  if (!choice.data.empty()) table.write(choice.data);
  forward(m, s.u, work.pose);
  expand_speeds(m, s.du, work.dq);
  const bool good = c.status == MotionStatus::good;
  Json coordinates = Json::array();
  for (int q = 0; q < m.q_count(); ++q)
    coordinates.push_back({{"name", m.coordinates[std::size_t(q)]},
                           {"value", in_file(m, q, work.pose.q[std::size_t(q)])},
                           {"speed_per_s", in_file(m, q, work.dq[std::size_t(q)])},
                           {"unit", unit_of(m, q)}});
  Json out{{"name", m.name},
           {"kind", "motion"},
           {"good", good},
           {"words", words(c.status)},
           {"seconds", c.at},
           {"steps", c.steps},
           {"kinetic_J", c.end.kinetic},
           {"potential_J", c.end.potential},
           {"most_kinetic_J", c.most_kinetic},
           {"energy_off_J", c.off},
           {"coordinates", coordinates}};
  if (!choice.data.empty()) out["file"] = choice.data;
  if (json) {
    print(out);
    return good ? core::kDone : core::kGoalNotReached;
  }
  fmt::print("{}", tr("{}: released at rest, {:.4g} s in {} steps{}\n", m.name, c.at, c.steps,
                      good ? std::string() : std::string("; ") + words(c.status)));
  fmt::print("{}",
             tr("  kinetic energy at most {:.4g} J, total energy constant within {:.2g} J\n", c.most_kinetic, c.off));
  for (const Json& coordinate : coordinates)
    fmt::print("  {:28} {:>12.5f} {} {:>14.4f} {}/s\n", coordinate["name"].get<std::string>(),
               coordinate["value"].get<double>(), coordinate["unit"].get<std::string>(),
               coordinate["speed_per_s"].get<double>(), coordinate["unit"].get<std::string>());
  return good ? core::kDone : core::kGoalNotReached;
}

}  // namespace trocar::app
