// Which moments of an attempt get a picture when pictures are taken without a window: everything that happens, and
// now and then the time in between.
#pragma once

#include <string>
#include <vector>

#include <trocar/attempt/session.hpp>

namespace trocar::pictures {

struct ShotMoment {
  std::string what, text;  ///< for the file's name, for people
};

/// Of the tick that the session has just done.
/// @param since  the tick from which on pictures are taken: the time in between begins after it
std::vector<ShotMoment> moments_to_show(const attempt::Session& session, std::uint64_t since);

}  // namespace trocar::pictures
