#include <algorithm>
#include <chrono>
#include <thread>

#include <trocar/attempt/interrupt.hpp>
#include <trocar/attempt/progress.hpp>
#include <trocar/core/log.hpp>
#include <trocar/core/tick.hpp>
#include <trocar/pictures/headless.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/pictures/shot_moments.hpp>
#include <trocar/pictures/video.hpp>

namespace trocar::pictures {
namespace {

constexpr std::uint64_t kTicksPerVideoFrame = core::kTicksPerSecond / kVideoRate;

/// Waits for a source that has nothing yet, and for the clock where time is to pass as it does.
class Patience {
 public:
  explicit Patience(bool real_time) : m_real_time(real_time) {}

  void before(attempt::InputSource& source) {
    const Clock::time_point begun = Clock::now();
    while (!source.ready() && !attempt::interrupted()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      if (Clock::now() - begun < kTold) continue;
      if (const std::string why = source.waits_for(); why != m_told && !why.empty())
        core::log::info("waiting: {}", m_told = why);
    }
    if (!m_real_time) return;
    m_due = std::max(m_due + kTickTime, Clock::now() - kDebt);
    if (source.behind() < kHurry) std::this_thread::sleep_until(m_due);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::microseconds kTickTime{1'000'000 / core::kTicksPerSecond};
  static constexpr std::chrono::milliseconds kTold{500}, kDebt{30};
  static constexpr std::uint64_t kHurry = 30;  // ticks
  bool m_real_time;
  Clock::time_point m_due = Clock::now();
  std::string m_told;
};

}  // namespace

Leftovers run_headless(attempt::Session& session, attempt::InputSource& source, const HeadlessOptions& options,
                       const std::function<bool()>& each_tick) {
  const sim::Model& model = session.lesson().model;
  attempt::catch_interrupts();
  std::unique_ptr<Pictures> pictures;
  std::unique_ptr<Shots> shots;
  std::unique_ptr<Video> video;
  if (!options.shots.empty() || !options.video.empty())
    pictures = std::make_unique<Pictures>(model, options.size, options.look);
  if (!options.shots.empty()) {
    shots = std::make_unique<Shots>(*pictures, options.shots);
    shots->take(session.state(), "start", "the start");
  }
  if (!options.video.empty()) video = Video::open(options.video, options.size);
  std::optional<DataFrames> data;
  if (!options.data.folder.empty()) data.emplace(model, options.data, options.size, options.look);

  const auto add_data = [&] {
    if (data && data->due(session.state().tick)) data->add(session.state(), {});
  };
  add_data();

  const std::uint64_t limit =
      options.seconds > 0 ? std::uint64_t(options.seconds * double(core::kTicksPerSecond)) : ~std::uint64_t(0);
  const std::uint64_t begin = session.state().tick;
  attempt::Progress progress(begin);
  sim::Input input = model.start;
  const auto goes_on = [&] {
    return !attempt::interrupted() && session.broken().empty() && session.state().tick < limit;
  };
  Patience patience(options.real_time);
  while (goes_on()) {
    patience.before(source);
    if (!goes_on() || !source.next(session.state(), input)) break;
    source.after(session.state(), session.advance(input));
    if (shots)
      for (const ShotMoment& m : moments_to_show(session, begin)) shots->take(session.state(), m.what, m.text);
    if (video && session.state().tick % kTicksPerVideoFrame == 0) video->add(pictures->draw(session.state()));
    add_data();
    if (each_tick && !each_tick()) break;
    progress.at(session.state().tick);
  }

  Leftovers left = Json::object();
  if (shots) {
    shots->take(session.state(), "end", "the end");
    shots->write_index();
    left["pictures"] = shots->files();
    left["picture_index"] = shots->index_file();
  }
  if (video && video->finish()) left["video"] = video->path();
  if (data) left["data"] = data->finish();
  return left;
}

}  // namespace trocar::pictures
