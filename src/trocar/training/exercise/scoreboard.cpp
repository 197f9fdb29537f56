#include <algorithm>

#include <trocar/sim/model/model.hpp>
#include <trocar/training/exercise/scoreboard.hpp>

namespace trocar::training {

Scoreboard::Scoreboard(const Exercise& exercise, Mode mode) : m_exercise(exercise), m_mode(mode) {
  m_errors.reserve(256);
}

int Scoreboard::add_step(const TaskText& text, const std::string& side, const std::string& title) {
  StepStatus s;
  s.name = title.empty() ? text.title : title + ": " + text.title;
  s.hint = text.hint;
  s.task = text.name;
  s.side = side;
  m_steps.push_back(std::move(s));
  m_weight.push_back(text.weight);
  m_true_for.push_back(0);
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

void Scoreboard::latch(int i, bool condition, double hold, double dt) {
  constexpr double kRounding = 1e-9;  // [s] in sums of samples
  double& held = m_true_for[size_t(i)];
  held = condition ? held + dt : 0;
  if (condition && held >= hold - kRounding) done(i);
}

bool Scoreboard::finished() const {
  return std::none_of(m_steps.begin(), m_steps.end(), [](const StepStatus& s) { return !s.done && !s.missed; });
}

void Scoreboard::make_error(const char* code, const std::string& side, Vec3d where, std::string detail) {
  ErrorMade e;
  e.code = code;
  e.detail = std::move(detail);
  e.side = side;
  e.at = now();
  e.where = where;
  if (const Penalty* p = m_exercise.penalty(e.code)) {
    e.name = p->name;
    e.meaning = p->meaning;
    e.hint = p->hint;
    e.points = p->points;
    e.fail = p->fail;
  }
  m_errors.push_back(std::move(e));
}

Score Scoreboard::score(double seconds) const {
  Score s;
  double reached = 0, whole = 0;
  for (size_t i = 0; i < m_steps.size(); ++i) {
    whole += m_weight[i];
    reached += m_steps[i].done ? m_weight[i] : 0;
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
