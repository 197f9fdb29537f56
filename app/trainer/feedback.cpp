#include "trainer/feedback.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <trocar/attempt/hand_names.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {
namespace {

constexpr double kSeconds = 4, kErrorSeconds = 7;        // near the picture
constexpr double kNear = 0.8, kFar = 0.7, kEvery = 0.6;  // of the limit; [s]

struct Kind {
  const char* what;
  ui::Mark mark;
  bool near_picture;
  std::optional<Tone> tone;
};
const Kind kKinds[] = {
    {"step-done", ui::Mark::done, true, Tone::step_done},
    {"error", ui::Mark::error, true, Tone::error},
    {"clipped", ui::Mark::note, false, Tone::clip},
    {"cut", ui::Mark::note, false, Tone::cut},
    {"parted", ui::Mark::note, false, {}},
    {"slipped", ui::Mark::warning, true, {}},
    {"clip-dropped", ui::Mark::warning, true, Tone::clip},
    {"closed-empty", ui::Mark::note, false, {}},
    {"grasped", ui::Mark::note, false, {}},
    {"released", ui::Mark::note, false, {}},
    {"exchanged", ui::Mark::note, false, {}},
};

}  // namespace

std::string clock_text(double seconds) {
  const int whole = int(std::max(0.0, seconds));
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

const Notice* Feedback::push(Notice notice) {
  if (m_notices.size() >= kMost) m_notices.erase(m_notices.begin());
  m_notices.push_back(std::move(notice));
  return &m_notices.back();
}

const Notice* Feedback::add(const attempt::Moment& moment, double clock, double now) {
  for (const Kind& k : kKinds) {
    if (moment.what != k.what) continue;
    const double seconds = k.mark == ui::Mark::error ? kErrorSeconds : kSeconds;
    std::string text = attempt::in_words(moment.text);
    if (k.mark == ui::Mark::done) text = tr("Done: {}", text);
    if (!moment.hint.empty()) text += "\n" + tr("Better: {}", moment.hint);
    return push({k.mark, text, clock, k.near_picture ? now + seconds : 0, k.tone});
  }
  return nullptr;
}

const Notice* Feedback::add(ui::Mark mark, const std::string& text, double clock, double now) {
  return push({mark, text, clock, now + kSeconds, {}});
}

std::vector<const Notice*> Feedback::fresh(double now) const {
  std::vector<const Notice*> out;
  for (const Notice& n : m_notices)
    if (n.until > now) out.push_back(&n);
  if (out.size() > kMostFresh) out.erase(out.begin(), out.end() - kMostFresh);
  return out;
}

bool PullWarning::due(double pull, double limit, double now) {
  m_near = limit > 0 && pull > (m_near ? kFar : kNear) * limit;
  if (!m_near || now < m_next) return false;
  m_next = now + kEvery;
  return true;
}

}  // namespace trocar::app
