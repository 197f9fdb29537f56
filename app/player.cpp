#include "player.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <future>
#include <iterator>
#include <thread>

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

#include <trocar/core/error.hpp>
#include <trocar/render/backend.hpp>
#include <trocar/render/gl_context.hpp>
#include <trocar/render/governor.hpp>

#include "camera_choice.hpp"
#include "command.hpp"
#include "event_log.hpp"
#include "film_plan.hpp"
#include "footage.hpp"
#include "interrupt.hpp"
#include "player_bar.hpp"
#include "player_panel.hpp"
#include "settings.hpp"
#include "ui.hpp"
#include "window.hpp"

namespace trocar::app {

namespace fs = std::filesystem;

namespace {

constexpr double kPlayingRate = 62, kRestingRate = 25;  // [pictures/s] at most
constexpr double kTurnPerPixel = 0.006;                 // [rad]
constexpr double kZoomPerNotch = 0.12;
constexpr float kInset = 0.3f;                                // of the picture's width
constexpr std::uint64_t kNearEnough = 40;                     // ticks: while playing an exact State so old is shown
constexpr auto kFilmShare = std::chrono::milliseconds(80);    // of each of the window's pictures goes to the film
constexpr double kRest = 0.3;                                 // [s] without a change: drawn at full quality
constexpr std::uint64_t kExposureStep = 500;                  // [ms] of a camera's time that a jump takes
constexpr std::uint64_t kSettling = 4, kSettlingStep = 2000;  // pictures, [ms]: before a film begins
constexpr int kScopeEye = 0, kOutsideEye = 1, kFilmEye = 2;   // exposure memories

Window open_window(const PlayerOptions& options) {
  try {
    return Window("Trocar: " + fs::path(options.file).filename().string(), options.size);
  } catch (const core::EnvironmentLacks& lacks) {
    throw core::EnvironmentLacks(fmt::format(
        "{}\nA recording without a window: trocar replay {} with --shots DIR, --video FILE, --verify or --headless",
        lacks.what(), options.file));
  }
}

/// Where the processor draws, the quick pictures begin at the lowest quality: the governor raises it if there is room.
std::size_t first_level(const std::string& driver) {
  return driver.find("llvmpipe") != std::string::npos ? render::quality_levels().size() - 1 : 0;
}

/// A part of the window [px, from the top left].
struct Area {
  float x = 0, y = 0, width = 0, height = 0;
  bool holds(ImVec2 p) const { return p.x >= x && p.x < x + width && p.y >= y && p.y < y + height; }
};

/// What the scene's picture depends on: while it stays the same the picture is not drawn again, so that panel and
/// timeline answer at once on a machine that draws slowly.
struct Drawn {
  std::uint64_t tick = Reel::kNowhere;
  bool exact = false, endoscope = false, inset = false;
  double yaw = 0, pitch = 0, distance = 0;
  Vec3d target;
  int width = 0, height = 0;
  render::Quality quality;

  friend bool operator==(const Drawn& a, const Drawn& b) {
    return a.tick == b.tick && a.exact == b.exact && a.endoscope == b.endoscope && a.inset == b.inset &&
           a.yaw == b.yaw && a.pitch == b.pitch && a.distance == b.distance && a.target.x == b.target.x &&
           a.target.y == b.target.y && a.target.z == b.target.z && a.width == b.width && a.height == b.height &&
           a.quality == b.quality;
  }
};

/// A copy of a part of the window's picture, drawn again below the panels.
class Backdrop {
 public:
  ~Backdrop() {
    if (m_texture != 0) glDeleteTextures(1, &m_texture);
  }
  void copy(int x, int y, int width, int height) {  // from the lower left [px]
    if (m_texture == 0) glGenTextures(1, &m_texture);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glReadBuffer(GL_BACK);
    glBindTexture(GL_TEXTURE_2D, m_texture);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, x, y, width, height, 0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glBindTexture(GL_TEXTURE_2D, 0);
  }
  void draw(const Area& area) const {
    ImGui::GetBackgroundDrawList()->AddImage(reinterpret_cast<ImTextureID>(std::uintptr_t(m_texture)), {area.x, area.y},
                                             {area.x + area.width, area.y + area.height}, {0, 1}, {1, 0});
  }

 private:
  unsigned m_texture = 0;
};

/// The first "a.000.png", "a.001.png" ... beside the recording that is not there yet.
fs::path free_name(const std::string& recording, const char* ending) {
  std::error_code ignored;
  for (int n = 0;; ++n) {
    fs::path path = recording;
    path.replace_extension(fmt::format("{:03}{}", n, ending));
    if (n == 9999 || !fs::exists(path, ignored)) return path;
  }
}

/// A film that is being made, a picture at a time, as the reel gets there.
struct FilmJob {
  FilmPlan plan;
  view::ViewOptions view;
  PictureSize size;
  std::unique_ptr<Video> video;
  std::uint64_t next = 0;
  bool settled = false;  ///< has its exposure found what it will begin with?
};

class Player {
 public:
  Player(Window& window, const Lesson& lesson, const sim::Recording& recording, const PlayerOptions& options,
         EventLog& log)
      : m_window(window),
        m_lesson(lesson),
        m_recording(recording),
        m_options(options),
        m_log(log),
        m_context(render::GlContext::adopt_current()),
        m_backend(render::make_gl_backend(*m_context)),
        m_view(lesson.model, *m_backend),
        m_governor(render::Governor::Limits{}, first_level(m_context->description())),
        m_footage(lesson.model, recording.keyframes),
        m_reel(lesson, recording, Reel::Options{}),
        m_line(m_reel.last()),
        m_around(view::orbit_around(lesson.model)),
        m_orbit(orbit_of(choice_of(kCameraPresets[0]), m_around)) {}

  void run() {
    log_camera();
    while (!m_window.wants_to_close() && !m_quit && !interrupted()) picture();
  }

 private:
  void picture();
  void listen(PlayerCommands& commands);
  void obey(const PlayerCommands& commands);
  void obey_times(const PlayerCommands& commands);
  void obey_cameras(const PlayerCommands& commands);
  void seek(std::uint64_t tick);
  void play_on();
  void lay_out();
  void read_pointer(PlayerCommands& commands);
  const sim::State& state_to_show();
  void show_scene(const sim::State& state);
  void draw_scene(const sim::State& state, const render::Quality& quality);
  void frame_inset();
  view::ViewOptions view_now(bool endoscope, const render::Quality& quality) const;
  render::Target target(const Area& area) const;
  void draw_overlays();
  void save_picture(const sim::State& state);
  void start_film();
  void film_on();
  void end_film(const std::string& message);
  void log_widgets();
  void log_shown(const sim::State& state);
  void log_camera();

  std::uint64_t now() const { return std::uint64_t(m_now + 0.5); }
  bool overlay() const { return m_help || m_menu || m_film; }

  using Clock = std::chrono::steady_clock;
  Window& m_window;
  const Lesson& m_lesson;
  const sim::Recording& m_recording;
  const PlayerOptions& m_options;
  EventLog& m_log;
  std::unique_ptr<render::GlContext> m_context;
  std::unique_ptr<render::Backend> m_backend;
  view::SceneView m_view;
  render::Governor m_governor;
  Backdrop m_backdrop;
  Drawn m_drawn;
  std::uint64_t m_picture_clock = 0;  ///< [ms] what the exposure goes by: a camera's own time, not the recording's
  Footage m_footage;
  Reel m_reel;
  Timeline m_line;
  Findings m_found;
  std::uint64_t m_found_version = 0;
  PadReader m_pad;

  double m_now = 0;  ///< [ticks]
  double m_speed = 1;
  bool m_playing = false, m_endoscope = true, m_inset = true, m_exact = false;
  bool m_help = false, m_menu = false, m_quit = false, m_picture_wanted = false;
  int m_preset = 1;
  view::Orbit m_around, m_orbit;
  Area m_main, m_small, m_bar, m_panel;
  enum class Drag { none, turn, shift } m_drag = Drag::none;
  std::string m_message;
  std::unique_ptr<FilmJob> m_film;
  std::vector<ui::Widget> m_widgets;
  std::string m_screen;
  std::uint64_t m_logged_tick = Reel::kNowhere;
  bool m_logged_exact = false;
  Clock::time_point m_asked_at = Clock::now();
};

void Player::seek(std::uint64_t tick) {
  tick = std::min(tick, m_line.last());
  if (tick == now()) return;
  m_now = double(tick);
  m_asked_at = Clock::now();
}

void Player::obey_times(const PlayerCommands& c) {
  if (c.toggle_play) {
    if (!m_playing && now() >= m_line.last()) seek(0);
    m_playing = !m_playing;
  }
  if (c.to_start) seek(0);
  if (c.to_end) seek(m_line.last());
  if (c.ticks != 0) {
    m_playing = false;
    seek(std::uint64_t(std::max(0.0, double(now()) + c.ticks)));
  }
  if (c.scrub != 0) {
    m_now = std::clamp(m_now + c.scrub * (m_line.to() - m_line.from()), 0.0, double(m_line.last()));
    m_asked_at = Clock::now();
  }
  if (c.next_mark)
    if (const TimelineMark* mark = next_mark(m_found.marks, now())) seek(mark->tick);
  if (c.previous_mark)
    if (const TimelineMark* mark = previous_mark(m_found.marks, now())) seek(mark->tick);
  if (c.faster) m_speed = next_speed(m_speed, true);
  if (c.slower) m_speed = next_speed(m_speed, false);
  if (c.zoom_in) m_line.zoom(0.5, m_now);
  if (c.zoom_out) m_line.zoom(2, m_now);
  if (c.show_all) m_line.show_all();
}

void Player::obey_cameras(const PlayerCommands& c) {
  const bool endoscope = m_endoscope, inset = m_inset;
  const int presets = int(std::size(kCameraPresets));
  int preset = c.preset;
  if (c.next_preset) preset = m_endoscope ? 1 : (m_preset + 1) % (presets + 1);  // 0: the endoscope, and round again
  if (preset == 0) m_endoscope = true;
  if (preset > 0 && preset <= presets) {
    m_endoscope = false;
    m_preset = preset;
    m_orbit = orbit_of(choice_of(kCameraPresets[preset - 1]), m_around);
  }
  if (c.swap) m_endoscope = !m_endoscope;
  if (c.inset) m_inset = !m_inset;
  const bool turned = c.turn_yaw != 0 || c.turn_pitch != 0 || c.pan_right != 0 || c.pan_up != 0 || c.closer != 0;
  if (turned) {
    m_orbit.turn(c.turn_yaw, c.turn_pitch);
    m_orbit.pan(c.pan_right * m_orbit.distance, c.pan_up * m_orbit.distance);
    m_orbit.zoom(std::exp(-c.closer));
    if (m_endoscope && !m_inset) m_endoscope = false;  // what is turned shall be seen
  }
  if (!turned && preset < 0 && endoscope == m_endoscope && inset == m_inset) return;
  m_asked_at = Clock::now();
  log_camera();
}

void Player::obey(const PlayerCommands& c) {
  obey_times(c);
  obey_cameras(c);
  if (c.picture) m_picture_wanted = true;
  if (c.film) start_film();
}

void Player::play_on() {
  if (!m_playing) return;
  m_now += m_window.picture_time() * 1000 * m_speed;
  m_asked_at = Clock::now();
  if (m_now < double(m_line.last())) return;
  m_now = double(m_line.last());
  m_playing = false;
}

void Player::lay_out() {
  const float scale = m_window.scale(), width = float(m_window.width()), height = float(m_window.height());
  const float panel = std::floor(std::min(kPlayerPanelWidth * scale, 0.5f * width));
  const float bar = std::floor(std::min(kBarHeight * scale, 0.5f * height));
  m_main = {0, 0, std::max(1.0f, width - panel), std::max(1.0f, height - bar)};
  m_panel = {m_main.width, 0, panel, height};
  m_bar = {0, m_main.height, m_main.width, bar};
  const float w = std::max(1.0f, std::floor(kInset * m_main.width)), gap = std::floor(10 * scale);
  const float h = std::max(1.0f, std::floor(std::min(0.75f * w, m_main.height)));
  m_small = {std::max(0.0f, m_main.width - w - gap), std::min(gap, m_main.height - h), w, h};
}

/// The mouse over the pictures: turns and shifts the outside camera, wherever that is shown.
void Player::read_pointer(PlayerCommands& c) {
  const ImGuiIO& io = ImGui::GetIO();
  const bool over_small = m_inset && m_small.holds(io.MousePos);
  const bool over = m_main.holds(io.MousePos) && !io.WantCaptureMouse;
  const bool over_outside = over && (over_small ? m_endoscope : !m_endoscope);
  if (!io.MouseDown[0] && !io.MouseDown[1] && !io.MouseDown[2]) m_drag = Drag::none;
  if (over_outside && io.MouseClicked[0]) m_drag = io.KeyShift ? Drag::shift : Drag::turn;
  if (over_outside && (io.MouseClicked[1] || io.MouseClicked[2])) m_drag = Drag::shift;
  if (over && io.MouseDoubleClicked[0]) c.swap = true;
  if (over_outside && io.MouseWheel != 0) c.closer += kZoomPerNotch * double(io.MouseWheel);
  const double height = double(m_endoscope ? m_small.height : m_main.height);
  if (m_drag == Drag::turn) {
    c.turn_yaw -= kTurnPerPixel * double(io.MouseDelta.x);
    c.turn_pitch += kTurnPerPixel * double(io.MouseDelta.y);
  } else if (m_drag == Drag::shift) {
    c.pan_right -= 0.75 * double(io.MouseDelta.x) / height;
    c.pan_up += 0.75 * double(io.MouseDelta.y) / height;
  }
}

/// Keys, gamepad and pointer; help and menu come and go.
void Player::listen(PlayerCommands& commands) {
  const devices::Gamepad& pad = m_window.gamepads().state();
  const WindowKeys& keys = m_window.keys();
  PlayerCommands ignored;
  if (!overlay()) {
    read_keys(m_window.typed(), m_window.picture_time(), commands);
    read_pointer(commands);
  }
  m_pad.read(pad, m_window.picture_time(), overlay() ? ignored : commands);
  m_picture_wanted = keys.picture;
  if (m_film) return;
  if (keys.help) m_help = !m_help;
  const bool back = keys.back && (overlay() || !pad.has(devices::Button::b));  // B means something else outside menus
  if (!back && !keys.pause) return;
  if (m_help)
    m_help = false;
  else
    m_menu = !m_menu;
}

const sim::State& Player::state_to_show() {
  const std::uint64_t wanted = now();
  m_reel.look_at(wanted, m_playing);
  m_reel.refresh();
  const sim::State& exact = m_reel.exact();
  const bool trusted = m_reel.replays() && wanted < m_reel.differs_from();
  const bool late = m_playing && exact.tick <= wanted && wanted - exact.tick <= kNearEnough;
  m_exact = trusted && (exact.tick == wanted || late);
  return m_exact || m_footage.empty() ? exact : m_footage.at(wanted);
}

view::ViewOptions Player::view_now(bool endoscope, const render::Quality& quality) const {
  view::ViewOptions options = endoscope ? view::ViewOptions{} : view_of(m_orbit);
  options.quality = quality;
  return options;
}

/// The window's lower left corner is OpenGL's origin.
render::Target Player::target(const Area& a) const {
  render::Target t = render::Target::window(int(a.width), int(a.height));
  t.x = int(a.x);
  t.y = m_window.height() - int(a.y) - int(a.height);
  return t;
}

/// Draws it where it is not what was drawn last: quickly while things move, at full quality once they rest.
void Player::show_scene(const sim::State& state) {
  const double rested = std::chrono::duration<double>(Clock::now() - m_asked_at).count();
  const bool moving = m_playing || m_drag != Drag::none || rested < kRest;
  Drawn wanted{state.tick,
               m_exact,
               m_endoscope,
               m_inset,
               m_orbit.yaw,
               m_orbit.pitch,
               m_orbit.distance,
               m_orbit.target,
               m_window.width(),
               m_window.height(),
               moving ? m_governor.quality() : render::Quality{}};
  if (!(wanted == m_drawn)) {
    const Clock::time_point start = Clock::now();
    draw_scene(state, wanted.quality);
    m_backdrop.copy(0, m_window.height() - int(m_main.height), int(m_main.width), int(m_main.height));
    m_drawn = wanted;
    if (moving) m_governor.frame_took(std::chrono::duration<double>(Clock::now() - start).count());
  }
  m_backdrop.draw(m_main);
}

void Player::draw_scene(const sim::State& state, const render::Quality& quality) {
  m_picture_clock += m_playing ? std::uint64_t(1000 * m_window.picture_time()) : kExposureStep;
  const auto draw = [&](bool endoscope, int eye, const Area& area) {
    view::ViewOptions options = view_now(endoscope, quality);
    options.eye_index = eye;
    render::Frame frame = m_view.frame(state, options);
    frame.tick = m_picture_clock;
    render::draw_frame(*m_backend, frame, target(area));
  };
  draw(m_endoscope, m_endoscope ? kScopeEye : kOutsideEye, m_main);
  if (m_inset) draw(!m_endoscope, m_endoscope ? kOutsideEye : kScopeEye, m_small);
}

void Player::frame_inset() {
  ImDrawList& over = *ImGui::GetBackgroundDrawList();
  const float scale = m_window.scale();
  const auto label = [&](const Area& a, bool endoscope) {
    over.AddText({a.x + 8 * scale, a.y + 6 * scale}, IM_COL32(235, 235, 235, 220),
                 endoscope ? "endoscope, as recorded" : "from outside");
  };
  label(m_main, m_endoscope);
  if (!m_inset) return;
  over.AddRect({m_small.x, m_small.y}, {m_small.x + m_small.width, m_small.y + m_small.height},
               IM_COL32(200, 205, 212, 255), 0, 0, 1.5f * scale);
  label(m_small, !m_endoscope);
}

void Player::draw_overlays() {
  if (m_film) {
    const double share = double(m_film->next) / double(m_film->plan.pictures());
    if (!draw_film_progress(m_film->video->path(), share) || m_window.keys().back) end_film("no film: cancelled");
    return;
  }
  if (m_menu) {
    const PlayerChoice choice = draw_player_menu();
    if (choice != PlayerChoice::none) m_menu = false;
    if (choice == PlayerChoice::film) start_film();
    if (choice == PlayerChoice::help) m_help = true;
    if (choice == PlayerChoice::quit) m_quit = true;
    if (choice == PlayerChoice::picture) m_picture_wanted = true;
  }
  if (m_help) draw_player_help();
}

void Player::picture() {
  m_window.set_picture_rate(m_playing || m_drag != Drag::none ? kPlayingRate : kRestingRate);
  m_window.begin_picture();
  lay_out();
  m_reel.findings(m_found_version, m_found);
  PlayerCommands commands;
  listen(commands);
  std::uint64_t wanted = now();
  draw_bar({m_found, now(), m_reel.known_until(), m_reel.differs_from(), m_playing, m_endoscope, m_inset, m_speed},
           m_line, m_bar.width, m_bar.y, m_bar.height, commands, wanted);
  if (m_film) {
    film_on();
  } else {
    if (wanted != now()) {
      m_playing = false;
      seek(wanted);
    }
    obey(commands);
    play_on();
    m_line.follow(m_now);
  }
  const sim::State& state = m_film ? m_reel.exact() : state_to_show();
  if (!m_film) {
    show_scene(state);
    frame_inset();
  }
  draw_player_panel(
      {m_lesson, m_recording, m_found, state, now(), m_line.last(), m_reel.known_until(), m_reel.replays(), m_exact,
       m_reel.complete(), now() >= m_reel.differs_from(), m_reel.way_to_go(), m_message},
      m_panel.x, m_panel.width, m_panel.height);
  draw_overlays();
  if (m_picture_wanted && !m_film) save_picture(state);
  m_window.draw_panels();
  m_window.show();
  log_widgets();
  if (!m_film) log_shown(state);
}

/// The large picture alone, at full quality.
void Player::save_picture(const sim::State& state) {
  const fs::path file = free_name(m_options.file, ".png");
  view::ViewOptions options = view_now(m_endoscope, {});
  options.eye_index = m_endoscope ? kScopeEye : kOutsideEye;
  options.metering = false;
  try {
    render::draw_frame(*m_backend, m_view.frame(state, options),
                       render::Target::off_screen(int(m_main.width), int(m_main.height)));
    render::write_png(file.string(), m_backend->read_pixels());
    m_message = "saved " + file.string();
    m_log.event("picture", {{"file", file.string()}, {"tick", now()}, {"exact", m_exact}});
  } catch (const core::EnvironmentLacks& lacks) {
    m_message = lacks.what();
  }
}

void Player::start_film() {
  if (m_film) return;
  auto job = std::make_unique<FilmJob>();
  job->plan = {std::uint64_t(m_line.from() + 0.5), std::uint64_t(m_line.to() + 0.5), m_speed};
  job->size = {std::max(2, int(m_main.width) & ~1), std::max(2, int(m_main.height) & ~1)};
  job->view = view_now(m_endoscope, {});
  job->view.eye_index = kFilmEye;
  try {
    job->video = Video::open(free_name(m_options.file, ".mp4"), job->size);
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
    const auto draw_at = [&](std::uint64_t clock) {
      frame.tick = clock;
      render::draw_frame(*m_backend, frame, render::Target::off_screen(job.size.width, job.size.height));
    };
    for (std::uint64_t i = 0; !job.settled && i < kSettling; ++i) draw_at(i * kSettlingStep);
    job.settled = true;
    draw_at(kSettling * kSettlingStep + tick - job.plan.from);
    job.video->add(m_backend->read_pixels());
    if (job.video->broken()) return end_film("no film: ffmpeg gave up; is the disk full?");
    if (++job.next < job.plan.pictures()) continue;
    const std::string path = job.video->path();
    const bool good = job.video->finish();
    end_film(good ? "saved " + path : "no film: ffmpeg could not write it");
    if (good) m_log.event("film", {{"file", path}});
  }
}

void Player::end_film(const std::string& message) {
  m_film.reset();
  m_message = message;
  m_asked_at = Clock::now();
}

/// What can be pressed, and where, for tests that drive the real window.
void Player::log_widgets() {
  const std::vector<ui::Widget> widgets = ui::take_widgets();
  const char* screen = m_film ? "film" : m_help ? "help" : m_menu ? "menu" : "player";
  if (!m_log.on() || (widgets == m_widgets && m_screen == screen)) return;
  m_widgets = widgets;
  m_screen = screen;
  Json places = Json::object();
  for (const ui::Widget& w : widgets) places[w.id] = {w.x, w.y};
  const auto place = [](const Area& a) { return Json{a.x, a.y, a.width, a.height}; };
  m_log.event("screen", {{"name", screen},
                         {"widgets", places},
                         {"large", place(m_main)},
                         {"small", place(m_small)},
                         {"bar", place(m_bar)}});
}

void Player::log_shown(const sim::State& state) {
  if (!m_log.on() || (m_logged_tick == now() && m_logged_exact == m_exact)) return;
  const double took = std::chrono::duration<double, std::milli>(Clock::now() - m_asked_at).count();
  Json details{{"tick", now()}, {"state_tick", state.tick}, {"exact", m_exact}, {"playing", m_playing}, {"ms", took}};
  if (m_exact && !m_playing) details["hash"] = hex(sim::hash_of(state));
  if (m_logged_tick == Reel::kNowhere) details["last"] = m_line.last();
  m_log.event("shown", details);
  m_logged_tick = now();
  m_logged_exact = m_exact;
}

void Player::log_camera() {
  m_log.event("camera", {{"endoscope", m_endoscope},
                         {"inset", m_inset},
                         {"yaw", m_orbit.yaw},
                         {"pitch", m_orbit.pitch},
                         {"distance", m_orbit.distance}});
}

/// Reads and compiles the recording's scene while the window says so.
std::unique_ptr<Lesson> load_in(Window& window, const std::string& exercise, std::uint64_t seed) {
  std::future<std::unique_ptr<Lesson>> lesson = std::async(std::launch::async, load_lesson, exercise, seed);
  do {
    window.begin_picture();
    draw_waiting("Preparing the scene", -1);
    window.draw_panels();
    window.show();
  } while (lesson.wait_for(std::chrono::milliseconds(10)) != std::future_status::ready);
  return lesson.get();
}

}  // namespace

void run_player(const sim::Recording& recording, const PlayerOptions& options) {
  Window window = open_window(options);
  std::vector<core::Fault> ignored;  // told by the trainer's start screen, where they can be mended
  window.set_text_size(read_settings(settings_file(), ignored).text_size);
  EventLog log(EventLog::path_of(options.log));
  catch_interrupts();
  const std::unique_ptr<Lesson> lesson = load_in(window, options.exercise, recording.header.seed);
  Player player(window, *lesson, recording, options, log);
  player.run();
}

}  // namespace trocar::app
