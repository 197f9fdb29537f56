#include <array>
#include <cerrno>
#include <chrono>

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>
#include <trocar/devices/steady_now.hpp>
#include <trocar/devices/tcp_client.hpp>
#include <trocar/devices/tracker/tracker_thread.hpp>

namespace trocar::devices {
namespace {

constexpr int kLookEvery = 50;                              // whether it is over [ms]
constexpr auto kTryAgain = std::chrono::milliseconds(300);  // after every end and every refusal of a connection

/// The place of a name; null: the list is full. Who sends ever new names is heard with the first ones only.
template <class T>
TrackerThread::Heard<T>* place_of(std::map<std::string, TrackerThread::Heard<T>>& all, const std::string& name) {
  const auto found = all.find(name);
  if (found != all.end()) return &found->second;
  return all.size() >= IgtlReader::kMostTools ? nullptr : &all[name];
}

/// The newest of each name.
template <class T>
void note(std::map<std::string, TrackerThread::Heard<T>>& all, const T& what) {
  if (TrackerThread::Heard<T>* heard = place_of(all, what.name)) *heard = {what, steady_now(), heard->times + 1, {}};
}

/// What is known of a tool that is not seen stays.
void note_unseen(std::map<std::string, TrackerThread::Heard<TrackedPose>>& all, const UnseenTool& tool) {
  bool known = false;
  for (auto& [name, heard] : all) {
    if (!same_tool_name(name, tool.name)) continue;
    heard.unseen = tool.why;
    known = true;
  }
  TrackerThread::Heard<TrackedPose>* heard = known ? nullptr : place_of(all, tool.name);
  if (heard) heard->what.name = tool.name, heard->unseen = tool.why;
}

/// Of that name, else of one that is the same but for the letters that the protocol cuts, if there is only one.
template <class T>
std::optional<TrackerThread::Heard<T>> newest(const std::map<std::string, TrackerThread::Heard<T>>& all,
                                              const std::string& name) {
  if (const auto found = all.find(name); found != all.end()) return found->second;
  const TrackerThread::Heard<T>* only = nullptr;
  for (const auto& [sent, heard] : all) {
    if (!same_tool_name(name, sent)) continue;
    if (only) return std::nullopt;
    only = &heard;
  }
  return only ? std::optional(*only) : std::nullopt;
}

}  // namespace

TrackerThread::TrackerThread(std::string address, int port) : m_address(std::move(address)), m_port(port) {
  std::string why;
  m_socket = connect_tcp(m_address, m_port, why);
  if (m_socket < 0)
    throw core::EnvironmentLacks(
        tr("no server at {} ({}): start the tracker's server (OpenIGTLink), or correct its address in the "
           "file's \"server\"",
           place(), why));
  m_status.connected = true, m_status.connections = 1;
  m_thread = std::thread([this] { loop(); });
}

TrackerThread::~TrackerThread() {
  m_stop = true;
  m_thread.join();
  if (m_socket >= 0) close(m_socket);
}

void TrackerThread::loop() {
  while (!m_stop) {
    if (m_socket >= 0) {
      listen();
      continue;
    }
    std::this_thread::sleep_for(kTryAgain);
    std::string ignored;
    m_socket = connect_tcp(m_address, m_port, ignored);
    if (m_socket < 0) continue;
    const std::lock_guard lock(m_lock);
    m_status.connected = true;
    ++m_status.connections;
  }
}

void TrackerThread::listen() {
  pollfd who{m_socket, POLLIN, 0};
  if (poll(&who, 1, kLookEvery) <= 0) return;
  std::array<std::uint8_t, 4096> bytes;
  const ssize_t got = recv(m_socket, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got <= 0) return hang_up();
  bool sound = true;
  {
    const std::lock_guard lock(m_lock);
    sound = m_reader.hear(std::span(bytes).first(std::size_t(got)),
                          {[this](const TrackedPose& pose) { note(m_poses, pose); },
                           [this](const UnseenTool& tool) { note_unseen(m_poses, tool); },
                           [this](const SensorValues& values) { note(m_values, values); }});
    m_status.messages = m_messages_before + m_reader.messages();
    m_status.damaged = m_damaged_before + m_reader.damaged();
  }
  if (!sound) hang_up();
}

void TrackerThread::hang_up() {
  close(m_socket);
  m_socket = -1;
  const std::lock_guard lock(m_lock);
  m_messages_before = m_status.messages, m_damaged_before = m_status.damaged;
  m_reader = IgtlReader();
  m_status.connected = false;
}

std::optional<TrackerThread::Heard<TrackedPose>> TrackerThread::pose(const std::string& name) const {
  const std::lock_guard lock(m_lock);
  return newest(m_poses, name);
}

std::optional<TrackerThread::Heard<SensorValues>> TrackerThread::values(const std::string& name) const {
  const std::lock_guard lock(m_lock);
  return newest(m_values, name);
}

std::vector<TrackerThread::Heard<TrackedPose>> TrackerThread::poses() const {
  const std::lock_guard lock(m_lock);
  std::vector<Heard<TrackedPose>> all;
  for (const auto& [name, heard] : m_poses) all.push_back(heard);
  return all;
}

std::vector<TrackerThread::Heard<SensorValues>> TrackerThread::all_values() const {
  const std::lock_guard lock(m_lock);
  std::vector<Heard<SensorValues>> all;
  for (const auto& [name, heard] : m_values) all.push_back(heard);
  return all;
}

TrackerThread::Status TrackerThread::status() const {
  const std::lock_guard lock(m_lock);
  return m_status;
}

}  // namespace trocar::devices
