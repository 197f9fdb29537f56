// What forgetting a trainee would delete, before it is done.
#pragma once

#include <string>

#include <trocar/training/store/store.hpp>

namespace trocar::training {

/// What Store::forget() would delete and leave now; deletes nothing. @throws core::EnvironmentLacks
Store::Forgotten to_forget(const Store& store, const std::string& trainee);

}  // namespace trocar::training
