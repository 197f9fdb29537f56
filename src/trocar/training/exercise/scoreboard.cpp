#include <algorithm>

#include <trocar/sim/model/model.hpp>
#include <trocar/training/exercise/scoreboard.hpp>

namespace trocar::training {

Scoreboard::Scoreboard(const Exercise& exercise, Mode mode) : m_exercise(exercise), m_mode(mode) {
  m_errors.reserve(256);
}

int Scoreboard::add_step(StepStatus step, double weight) {
  m_steps.push_back(std::move(step));
  m_weight.push_back(weight);
  return int(m_steps.size()) - 1;
}

double Scoreboard::now() const { return double(m_now) * sim::kTick; }

void Scoreboard::done(int i) {
  if (!open(i)) return;
  m_steps[size_t(i)].done = true;
  m_steps[size_t(i)].at = now();
}

void Scoreboard::missed(int i) {
  if (!open(i)) return;
  m_steps[size_t(i)].missed = true;
  m_steps[size_t(i)].at = now();
}

void Scoreboard::undone(int i) {
  if (!m_steps[size_t(i)].done) return;
  m_steps[size_t(i)].done = false;
  m_steps[size_t(i)].at = 0;
}

bool Scoreboard::finished() const {
  return std::none_of(m_steps.begin(), m_steps.end(),
                      [](const StepStatus& s) { return !s.done && !s.missed && !s.optional; });
}

void Scoreboard::make_error(const Penalty& p, const std::string& side, Vec3d where, std::string detail) {
  m_errors.push_back({p.code, p.name, p.meaning, p.hint, std::move(detail), side, p.points, p.fail, now(), where});
}

Score Scoreboard::score(double seconds) const {
  Score s;
  double reached = 0, whole = 0;
  for (size_t i = 0; i < m_steps.size(); ++i) {
    const bool done = m_steps[i].done;
    whole += done || !m_steps[i].optional ? m_weight[i] : 0;
    reached += done ? m_weight[i] : 0;
  }
  s.quality = whole > 0 ? reached / whole : 0;
  const double spare = m_exercise.longest_time - m_exercise.expert_time;
  s.time = finished() ? std::clamp((m_exercise.longest_time - seconds) / spare, 0.0, 1.0) : 0;
  for (const ErrorMade& e : m_errors) {
    s.penalties += e.points;
    s.failed = s.failed || e.fail;
  }
  // Motion against a reference group is left out until there is one, and the rest renormalised.
  const double shares = m_exercise.quality_share + m_exercise.time_share;
  const double earned = m_exercise.quality_share * s.quality + m_exercise.time_share * s.time;
  s.total = std::clamp(100 * earned / shares - s.penalties, 0.0, 100.0);
  s.scored = m_mode == Mode::assessed;
  s.passed = s.scored && finished() && !s.failed && s.total >= m_exercise.pass_mark;
  return s;
}

}  // namespace trocar::training
