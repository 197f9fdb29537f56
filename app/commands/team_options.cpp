#include "commands/team_options.hpp"

#include <cstdlib>

#include <fmt/format.h>

#include <trocar/core/error.hpp>
#include <trocar/core/text.hpp>

namespace trocar::app {

Place parse_place(const std::string& text, const std::string& where) {
  const auto colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  const bool digits = !port.empty() && port.size() <= 5 && port.find_first_not_of("0123456789") == std::string::npos;
  if (colon == 0 || !digits || std::stoi(port) > 65535)
    throw core::BadInput({{{where, 0, 0}, tr("expected ADDRESS:PORT as 127.0.0.1:4711, got {}", text)}});
  return {text.substr(0, colon), std::stoi(port)};
}

void add_team_options(CLI::App& command, TeamChoice& choice) {
  const char* team = tr("Team over a network");
  command
      .add_option("--team", choice.roles,
                  tr("parts that other people control, with commas: camera, assistant, left, right, or a port's name; "
                     "the simulation pauses until they have joined (see trocar join)"))
      ->group(team);
  command
      .add_option("--team-at", choice.at,
                  tr("ADDRESS:PORT where they join; port 0: a free one; address 0.0.0.0: from other machines too"))
      ->capture_default_str()
      ->group(team);
  command.add_option("--token", choice.token, tr("the token that they must present; default: a random one, shown"))
      ->envname(kTokenVariable)
      ->group(team);
}

attempt::TeamPlan team_plan(const TeamChoice& choice) {
  const Place place = parse_place(choice.at, "--team-at");
  attempt::TeamPlan plan{place.address, place.port, choice.token, {}};
  for (std::size_t from = 0; from <= choice.roles.size();) {
    const std::size_t comma = std::min(choice.roles.find(',', from), choice.roles.size());
    plan.roles.push_back(choice.roles.substr(from, comma - from));
    from = comma + 1;
  }
  return plan;
}

std::string how_to_join(const attempt::TeamHost& team, const TeamChoice& choice) {
  std::string text;
  const std::string address = parse_place(choice.at, "--team-at").address;
  for (const attempt::TeamSeat& seat : team.seats()) {
    // Messages end up in logs: a token that was chosen is known to those who need it.
    const std::string token = choice.token.empty() ? team.token() : tr("YOUR_TOKEN");
    text += tr("\n  {}={} trocar join {}:{} --role {}", kTokenVariable, token, address, team.port(), seat.role);
  }
  return text;
}

}  // namespace trocar::app
