// What a team's programs say to each other: bytes of a kind, then its fields. What is not whole, too long or of no kind
// is no message.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <trocar/core/byte_code.hpp>
#include <trocar/sim/model/input.hpp>

namespace trocar::attempt::message {

/// The End of an attempt that came to its end.
inline constexpr const char* kFinished = "finished";

inline constexpr std::uint64_t kMostTicks = 1000;  ///< in one message

// From a member.
struct Hello {
  std::string role, version;
  std::uint64_t ticks = 0;  ///< that it has made already: it was here before
};
/// Where it wants its own hands or the camera to be.
struct Share {
  std::uint64_t number = 0;
  std::uint64_t sent_us = 0;  ///< by its clock: comes back with the ticks that have it
  sim::Input input;
};
/// Made so many ticks, what they came to, and how long its own motion took until it was in them.
struct Done {
  std::uint64_t ticks = 0;
  std::uint64_t hashed = 0, hash = 0;  ///< of the State after so many ticks; 0: not told
  std::uint64_t latency_us = 0;        ///< 0: not known
};

// From the host.
struct Attempt {
  std::string exercise, version;
  std::uint64_t seed = 0, model_hash = 0;
};
/// Everybody's inputs, tick by tick.
struct Ticks {
  std::uint64_t first = 0;
  std::vector<sim::Input> inputs;
  std::uint64_t number = 0, sent_us = 0;  ///< of the receiver's newest Share in them; 0: none
};
/// Paused: the reason, for people. Empty: it continues.
struct Waits {
  std::string why;
};
struct End {
  std::string why;
};

using Message = std::variant<Hello, Share, Done, Attempt, Ticks, Waits, End>;

core::ByteString coded(const Message& message);
std::optional<Message> decoded(core::ByteView bytes);

}  // namespace trocar::attempt::message
