#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

#include "player/player_parts.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr auto kFilmShare = std::chrono::milliseconds(80);    // of each of the window's pictures goes to the film
constexpr std::uint64_t kSettling = 4, kSettlingStep = 2000;  // pictures, [ms]: before a film begins

/// The first "a.000.png", "a.001.png" ... beside the recording that is not there yet.
fs::path free_name(const std::string& recording, const char* ending) {
  std::error_code ignored;
  for (int n = 0;; ++n) {
    fs::path path = recording;
    path.replace_extension(fmt::format("{:03}{}", n, ending));
    if (n == 9999 || !fs::exists(path, ignored)) return path;
  }
}

}  // namespace

/// The large picture alone, at full quality.
void Player::save_picture(const sim::State& state) {
  const fs::path file = free_name(m_options.file, ".png");
  view::ViewOptions options = view_of_first({});
  options.metering = false;

  try {
    const Area& area = m_panes.first().area;
    render::Frame frame = m_view.frame(state, options);
    fit_to(area, frame);
    render::draw_frame(m_backend, frame, render::Target::off_screen(int(area.width), int(area.height)));
    render::Image image = m_backend.read_pixels();
    if (options.analysis.on()) m_legend.paint(legend_of(options.analysis), image);
    render::write_png(file.string(), image);
    m_message = tr("Saved {}", file.string());
    m_log.event("picture", {{"file", file.string()}, {"tick", now()}, {"exact", m_exact}});
  } catch (const core::EnvironmentLacks& lacks) {
    m_message = lacks.what();
  }
}

void Player::start_film() {
  if (m_film) return;
  auto job = std::make_unique<FilmJob>();
  job->plan = {std::uint64_t(m_line.from() + 0.5), std::uint64_t(m_line.to() + 0.5), m_speed};
  const Area& area = m_panes.first().area;
  job->size = {std::max(2, int(area.width) & ~1), std::max(2, int(area.height) & ~1)};
  job->view = view_of_first({});
  job->view.eye_index = kFilmEye;
  try {
    job->video = pictures::Video::open(free_name(m_options.file, ".mp4"), job->size);
  } catch (const core::EnvironmentLacks& lacks) {
    m_message = lacks.what();
    m_log.event("film-failed", {{"why", m_message}});
    return;
  }
  m_log.event("film-started", {{"file", job->video->path()},
                               {"pictures", job->plan.pictures()},
                               {"from", job->plan.from},
                               {"to", job->plan.to}});
  m_playing = false;
  m_film = std::move(job);
}

/// The next pictures of the film, as far as their exact States are there.
void Player::film_on() {
  const Clock::time_point until = Clock::now() + kFilmShare;
  while (m_film && Clock::now() < until) {
    FilmJob& job = *m_film;
    const std::uint64_t tick = job.plan.tick(job.next);
    m_reel.look_at(tick, false);
    m_reel.refresh();
    const bool trusted = m_reel.replays() && tick < m_reel.differs_from();
    if (trusted && m_reel.exact().tick != tick) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    const sim::State& state = trusted || m_footage.empty() ? m_reel.exact() : m_footage.at(tick);
    render::Frame frame = m_view.frame(state, job.view);
    fit_to({0, 0, float(job.size.width), float(job.size.height)}, frame);
    const auto draw_at = [&](std::uint64_t clock) {
      frame.tick = clock;
      render::draw_frame(m_backend, frame, render::Target::off_screen(job.size.width, job.size.height));
    };
    for (std::uint64_t i = 0; !job.settled && i < kSettling; ++i) draw_at(i * kSettlingStep);
    job.settled = true;
    draw_at(kSettling * kSettlingStep + tick - job.plan.from);
    render::Image image = m_backend.read_pixels();
    if (job.view.analysis.on()) m_legend.paint(legend_of(job.view.analysis), image);
    job.video->add(image);
    if (job.video->broken()) return end_film(tr("No video: ffmpeg stopped. Check that the disk has free space."));
    if (++job.next < job.plan.pictures()) continue;
    const std::string path = job.video->path();
    const bool good = job.video->finish();
    end_film(good ? tr("Saved {}", path) : tr("No video: ffmpeg could not write {}.", path));
    if (good) m_log.event("film", {{"file", path}});
  }
}

void Player::end_film(const std::string& message) {
  m_film.reset();
  m_message = message;
  m_asked_at = Clock::now();
}

}  // namespace trocar::app
