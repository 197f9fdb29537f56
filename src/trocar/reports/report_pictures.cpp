// Key moments as pictures, drawn after the fact: from a recording's keyframes or from what a session has kept.
#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include <trocar/attempt/session.hpp>
#include <trocar/core/error.hpp>
#include <trocar/core/log.hpp>
#include <trocar/pictures/pictures.hpp>
#include <trocar/reports/report.hpp>
#include <trocar/sim/recording/keyframe.hpp>
#include <trocar/sim/recording/recording.hpp>

namespace trocar::reports {
namespace {

constexpr pictures::PictureSize kSize{640, 480};

struct Look {
  std::uint64_t tick = 0;
  std::string what, text;
  std::vector<std::uint8_t> display;
};

/// What a reader wants to see first.
int rank(const std::string& what) {
  static const std::vector<std::string> order{"error",   "step-done", "cut",      "clipped",
                                              "slipped", "grasped",   "released", "clip-dropped"};
  return int(std::find(order.begin(), order.end(), what) - order.begin());
}

/// The most telling ones, in order of time; several things at once are one picture.
std::vector<Look> chosen(std::vector<Look> looks) {
  std::stable_sort(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.tick < b.tick; });
  std::vector<Look> merged;
  for (Look& l : looks) {
    if (!merged.empty() && l.tick < merged.back().tick + 200) {
      merged.back().text += "; " + l.text;
      if (rank(l.what) < rank(merged.back().what)) merged.back().what = l.what;
      continue;
    }
    merged.push_back(std::move(l));
  }
  std::vector<std::size_t> order(merged.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rank(merged[a].what) < rank(merged[b].what); });
  if (order.size() > kMostPictures) order.resize(kMostPictures);
  std::sort(order.begin(), order.end());
  std::vector<Look> out;
  for (const std::size_t i : order) out.push_back(std::move(merged[i]));
  return out;
}

/// Empty, or why nothing was drawn.
std::string draw(Report& report, const sim::Model& model, const std::vector<Look>& looks,
                 const std::filesystem::path& folder) {
  std::string failure;
  std::thread([&] {  // another thread, another OpenGL context
    try {
      pictures::Pictures pictures(model, kSize);
      std::filesystem::create_directories(folder);
      sim::State state = sim::initial_state(model);
      for (const Look& look : looks) {
        if (!sim::restore_display(model, look.display, state)) {
          failure = "the recording's pictures do not fit the scene as it is now";
          continue;
        }
        state.tick = look.tick;
        const std::filesystem::path file = folder / fmt::format("moment-{:02}.png", report.pictures.size() + 1);
        render::write_png(file.string(), pictures.still(state));
        report.pictures.push_back({file, look.text, double(look.tick) * sim::kTick});
      }
    } catch (const std::exception& lacks) {
      failure = lacks.what();
    }
  })
      .join();
  return report.pictures.empty() ? failure : "";
}

std::vector<Look> moments_of(const Json& result) {
  std::vector<Look> looks;
  const auto moments = result.find("moments");
  if (moments == result.end() || !moments->is_array()) return looks;
  for (const Json& m : *moments)
    if (m.is_object() && m.contains("tick") && m["tick"].is_number_unsigned())
      looks.push_back({m["tick"].get<std::uint64_t>(), text_in(m, "what"), text_in(m, "text"), {}});
  return looks;
}

}  // namespace

void add_pictures(Report& report, const std::filesystem::path& file, const std::filesystem::path& folder) {
  try {
    const sim::Recording recording = sim::read_recording(file);
    std::vector<Look> looks = moments_of(report.result);
    if (looks.empty() && !recording.keyframes.empty())
      for (std::size_t i = 1; i <= 4; ++i)
        looks.push_back({recording.keyframes[(recording.keyframes.size() - 1) * i / 4].tick, "time", "on the way", {}});
    for (Look& look : looks) {
      // The first keyframe at or after the moment shows what it led to.
      const auto at = std::lower_bound(recording.keyframes.begin(), recording.keyframes.end(), look.tick,
                                       [](const sim::Keyframe& k, std::uint64_t t) { return k.tick < t; });
      if (at != recording.keyframes.end()) look.display = at->bytes;
    }
    looks.erase(std::remove_if(looks.begin(), looks.end(), [](const Look& l) { return l.display.empty(); }),
                looks.end());
    if (looks.empty()) {
      report.pictures_note = "the recording holds no moments to show";
      return;
    }
    const std::unique_ptr<attempt::Lesson> lesson =
        attempt::load_lesson(recording.header.exercise, recording.header.seed);
    report.pictures_note = draw(report, lesson->model, chosen(std::move(looks)), folder);
  } catch (const std::exception& bad) {
    report.pictures_note = bad.what();
  }
}

void add_pictures(Report& report, const attempt::Session& session, const std::filesystem::path& folder) {
  std::vector<Look> looks;
  for (const attempt::Session::KeptMoment& k : session.kept_moments())
    if (!k.display.empty()) looks.push_back({k.moment.tick, k.moment.what, k.moment.text, k.display});
  if (looks.empty()) return;
  report.pictures_note = draw(report, session.lesson().model, chosen(std::move(looks)), folder);
}

}  // namespace trocar::reports
