#include "rooms/room_beside.hpp"

#include <algorithm>
#include <stdexcept>

#include <trocar/core/error.hpp>
#include <trocar/scene/files/scene_folders.hpp>
#include <trocar/scene/operating_room/room_file.hpp>

#include "rooms/room_camera.hpp"
#include "rooms/room_hands.hpp"

namespace trocar::app {
namespace {

constexpr std::chrono::milliseconds kRoomPictures{100};  // pictures, at least
constexpr int kRestShare = 9;                            // times what the last one took: the simulation comes first
constexpr int kRoomEye = 7;                              // exposure memory

}  // namespace

std::filesystem::path room_path(const std::string& name, const char* folder) {
  return scene::file_or_name(name, folder, std::string_view(folder) == "rooms" ? "operating room" : "programme");
}

std::unique_ptr<studies::RoomModel> load_room(const std::string& name) {
  const std::filesystem::path path = room_path(name, "rooms");
  scene::Room room = scene::read_room(path);
  try {
    return std::make_unique<studies::RoomModel>(std::move(room));
  } catch (const std::invalid_argument& bad) {
    throw core::BadInput({{{path.generic_string(), 0, 0}, bad.what()}});
  }
}

RoomBeside::RoomBeside(Window& main, render::Backend& backend, const std::string& room)
    : m_backend(backend), m_room(load_room(room)), m_pose(m_room->start()) {
  m_drawing = std::make_unique<view::RoomDrawing>(backend, scenery_of(*m_room, m_pose));
  m_window = std::make_unique<SecondWindow>(main, "Trocar: " + m_room->room().name);
}

RoomBeside::~RoomBeside() = default;

void RoomBeside::follow(const sim::Model& model, const sim::State& state) {
  const RoomHands hands(*m_room, model);
  for (const RoomHands::Link& link : hands.links()) m_room->lead(m_pose, link.arm, hands.goal(link, state));
  m_pose.tips = hands.tips(state);
}

void RoomBeside::show(const sim::Model& model, const sim::State& state) {
  const auto now = std::chrono::steady_clock::now();
  if (!m_window || now < m_next) return;
  if (m_window->wants_to_close()) return m_window.reset();
  follow(model, state);
  m_drawing->move(scenery_of(*m_room, m_pose));
  render::Frame frame = m_drawing->frame(room_views()[1].orbit);
  frame.eye = kRoomEye;
  frame.quality.samples = 1;
  render::draw_frame(m_backend, frame, m_canvas.target(m_window->width(), m_window->height()));
  m_window->show(m_canvas, {});
  const auto done = std::chrono::steady_clock::now();
  m_next = std::max(now + std::chrono::steady_clock::duration(kRoomPictures), done + kRestShare * (done - now));
}

}  // namespace trocar::app
