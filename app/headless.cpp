#include "headless.hpp"

#include <chrono>
#include <string_view>

#include <fmt/format.h>

#include <trocar/core/log.hpp>

#include "interrupt.hpp"
#include "pictures.hpp"
#include "video.hpp"

namespace trocar::app {
namespace {

/// A line on stderr every few seconds of wall time.
class Progress {
 public:
  void tick(const Session& session) {
    if (session.state().tick % 256 != 0) return;
    const Clock::time_point now = Clock::now();
    if (now - m_last < std::chrono::seconds(5)) return;
    const double wall = std::chrono::duration<double>(now - m_start).count();
    const double simulated = double(session.state().tick - m_first) * sim::kTick;
    core::log::info("{:.1f} s simulated in {:.1f} s (x{:.2f})", simulated, wall, simulated / wall);
    m_last = now;
  }
  explicit Progress(const Session& session) : m_first(session.state().tick) {}

 private:
  using Clock = std::chrono::steady_clock;
  std::uint64_t m_first;
  Clock::time_point m_start = Clock::now(), m_last = m_start;
};

constexpr std::uint64_t kTicksPerVideoFrame = 1000 / kVideoRate;
constexpr std::uint64_t kTicksPerShot = 20'000;  // where nothing happens

/// A picture of everything that happens, and of the time in between.
void take_shots(Shots& shots, const Session& session) {
  const std::uint64_t tick = session.state().tick;
  for (const Moment& m : session.moments())
    if (std::string_view(m.what) != "closed-empty") shots.take(session.state(), m.what, m.text);
  if (session.moments().empty() && tick % kTicksPerShot == 0)
    shots.take(session.state(), "time", fmt::format("after {} s", tick / 1000));
}

}  // namespace

Leftovers run_headless(Session& session, InputSource& source, const HeadlessOptions& options,
                       const std::function<bool()>& each_tick) {
  const sim::Model& model = session.lesson().model;
  catch_interrupts();
  std::unique_ptr<Pictures> pictures;
  std::unique_ptr<Shots> shots;
  std::unique_ptr<Video> video;
  if (!options.shots.empty() || !options.video.empty()) pictures = std::make_unique<Pictures>(model, options.size);
  if (!options.shots.empty()) {
    shots = std::make_unique<Shots>(*pictures, options.shots);
    shots->take(session.state(), "start", "the start");
  }
  if (!options.video.empty()) video = Video::open(options.video, options.size);

  const std::uint64_t limit = options.seconds > 0 ? std::uint64_t(options.seconds * 1000) : ~std::uint64_t(0);
  Progress progress(session);
  sim::Input input = model.start;
  const auto goes_on = [&] { return !interrupted() && session.broken().empty() && session.state().tick < limit; };
  while (goes_on() && source.next(session.state(), input)) {
    session.advance(input);
    source.after(session.state());
    if (shots) take_shots(*shots, session);
    if (video && session.state().tick % kTicksPerVideoFrame == 0) video->add(pictures->draw(session.state()));
    if (each_tick && !each_tick()) break;
    progress.tick(session);
  }

  Leftovers left = Json::object();
  if (shots) {
    shots->take(session.state(), "end", "the end");
    shots->write_index();
    left["pictures"] = shots->files();
    left["picture_index"] = shots->index_file();
  }
  if (video && video->finish()) left["video"] = video->path();
  return left;
}

}  // namespace trocar::app
