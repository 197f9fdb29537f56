// The options by which several people do one attempt: who hosts says whom it expects and where it listens.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include <trocar/attempt/team/host.hpp>

namespace trocar::app {

struct TeamChoice {
  std::string roles;  ///< "camera,assistant"; empty: nobody else
  std::string at = "127.0.0.1:0", token;
};

/// A machine and a port: "127.0.0.1:4711".  @throws core::BadInput, naming `where`
struct Place {
  std::string address;
  int port = 0;
};
Place parse_place(const std::string& text, const std::string& where);

void add_team_options(CLI::App& command, TeamChoice& choice);
/// @throws core::BadInput
attempt::TeamPlan team_plan(const TeamChoice& choice);
/// What the others need to join, for people.
std::string how_to_join(const attempt::TeamHost& team, const TeamChoice& choice);

inline constexpr const char* kTokenVariable = "TROCAR_TOKEN";

}  // namespace trocar::app
