// trocar report --forget: what belongs to a trainee goes, after a question.
#pragma once

#include <filesystem>
#include <string>

#include <trocar/training/store/store.hpp>

namespace trocar::app {

struct ForgetChoice {
  std::string trainee;
  bool dry_run = false;  ///< only list it
  bool yes = false;      ///< do not ask
};

/// @throws core::BadInput for an unknown trainee, and where nobody can be asked
int forget_trainee(training::Store& store, const ForgetChoice& choice, bool json);

/// The folder of an attempt's page. A row may hold anything as its uuid, which must not lead elsewhere.
std::filesystem::path page_folder(const training::Store& store, const training::Attempt& attempt);

/// For an unknown trainee: "no attempts of Nobody; known: Ada, Bob".
std::string no_attempts_of(const training::Store& store, const std::string& trainee);

}  // namespace trocar::app
