#include <algorithm>

#include <trocar/training/exercise/rules.hpp>
#include <trocar/training/observe/hands.hpp>
#include <trocar/training/observe/marks.hpp>

namespace trocar::training {
namespace {

const std::string kNone;

}  // namespace

bool Rules::allowed(int step) const {
  const StepRule& rule = m_steps[size_t(step)];
  return std::all_of(rule.after.begin(), rule.after.end(), [this](int i) { return !m_board.open(i); }) &&
         std::all_of(rule.needs.begin(), rule.needs.end(), [this](int i) { return m_board.step(i).done; });
}

void Rules::tick(const Snapshot& snapshot, const sim::StepReport& report) {
  m_facts.tick(snapshot, report);
  note_holds(snapshot);
  m_events.tick(snapshot, report, [&](int event, const EventInstance& h) { happened(event, h, snapshot); });
}

void Rules::sample(const Snapshot& snapshot, double dt) {
  m_facts.sample(snapshot, dt);
  for (size_t h = 0; h < hands(snapshot.model) && m_guide.has_owners(); ++h)
    if (snapshot.state.tools[h].holds > 0) m_guide.work_on(snapshot.state.tools[h].hold[0].at.body);
  m_events.sample(snapshot, dt, [&](int event, const EventInstance& h) { happened(event, h, snapshot); });
  watch_errors(snapshot, dt);
  watch_steps(snapshot, dt);
  m_details.sample(snapshot);
}

void Rules::note_holds(const Snapshot& snapshot) {
  if (!m_guide.has_owners()) return;
  for (size_t h = 0; h < hands(snapshot.model); ++h)
    if (snapshot.state.tools[h].holds > 0) m_held_side[h] = m_guide.owner(snapshot.state.tools[h].hold[0].at.body);
}

/// The element of what a hand holds, or has just held.
const std::string& Rules::side_of(const EventInstance& h, const EventKind& kind, const Snapshot& snapshot) const {
  if (h.hand < 0 || kind.of_hold == EventKind::Hold::none) return kNone;
  const bool holds = kind.of_hold == EventKind::Hold::before || snapshot.state.tools[size_t(h.hand)].holds > 0;
  const std::string* side = holds ? m_held_side[size_t(h.hand)] : nullptr;
  return side ? *side : kNone;
}

void Rules::happened(int event, const EventInstance& h, const Snapshot& snapshot) {
  const EventKind& kind = *m_events.all()[size_t(event)].event;
  const std::string* element = h.body.exists() ? m_guide.work_on(h.body) : nullptr;
  const size_t before = m_board.errors().size();
  std::vector<int> closes;
  for (ErrorRule& rule : m_errors) {
    if (!rule.on.there() || (rule.once && rule.told)) continue;
    const Cause* cause = rule.on.of(event, snapshot, h);
    if (!cause) continue;
    rule.told = true;
    // What belongs to an element is shown on its body, all else where the instrument is.
    const std::string& side = rule.side.empty() ? side_of(h, kind, snapshot) : rule.side;
    const std::string& words = !cause->detail.empty() ? cause->detail : rule.detail;
    std::string detail = words.empty() ? std::string(h.detail) : words;
    if (const size_t at = detail.find("{on}"); at != std::string::npos)
      detail.replace(at, 4, h.name ? m_names.title_of(*h.name) : "nothing");
    m_board.make_error(*rule.penalty, side, rule.side.empty() ? h.tip : h.where, std::move(detail));
    closes.insert(closes.end(), rule.misses.begin(), rule.misses.end());
  }
  for (StepRule& rule : m_steps)
    if (rule.on.there() && m_board.open(rule.step) && allowed(rule.step) && rule.on.of(event, snapshot, h)) {
      m_board.done(rule.step);
      m_guide.step_done(rule.step);
    }
  for (StepRule& rule : m_steps)
    if (rule.missed_on.there() && m_board.open(rule.step) && rule.missed_on.of(event, snapshot, h))
      m_board.missed(rule.step);
  miss(closes);
  m_details.happened(event, h, snapshot, element ? *element : kNone, m_board.errors().size() == before);
}

void Rules::miss(const std::vector<int>& steps) {
  for (const int i : steps) m_board.missed(i);
}

void Rules::watch_errors(const Snapshot& snapshot, double dt) {
  for (ErrorRule& rule : m_errors) {
    if (!rule.when.there() || (rule.once && rule.told)) continue;
    const bool holds = rule.when.holds(snapshot) == TriState::yes;
    if (!holds) rule.told = false;
    if (!rule.held.update(holds, dt) || rule.told) continue;
    rule.told = true;
    const Vec3d where = rule.mark >= 0 ? place_of_mark(snapshot.model, snapshot.state, rule.mark) : Vec3d{};
    m_board.make_error(*rule.penalty, rule.side, where, rule.detail);
    miss(rule.misses);
  }
}

void Rules::watch_steps(const Snapshot& snapshot, double dt) {
  for (StepRule& rule : m_steps) {
    const int i = rule.step;
    if (m_board.open(i)) {
      const bool counts = rule.when.there() && allowed(i) && rule.when.holds(snapshot) == TriState::yes;
      if (rule.when.there() && rule.done_for.update(counts, dt)) {
        m_board.done(i);
        m_guide.step_done(i);
        continue;
      }
      const bool late = rule.missed_when.there() && rule.missed_when.holds(snapshot) == TriState::yes;
      const auto lost = [this](int n) { return m_board.step(n).missed; };
      if (rule.missed_for.update(late, dt) || std::any_of(rule.needs.begin(), rule.needs.end(), lost))
        m_board.missed(i);
    } else if (rule.undone_when.there() && m_board.step(i).done) {
      if (rule.undone_for.update(rule.undone_when.holds(snapshot) == TriState::yes, dt)) {
        m_board.undone(i);
        rule.done_for.held = rule.undone_for.held = 0;
      }
    }
  }
}

}  // namespace trocar::training
