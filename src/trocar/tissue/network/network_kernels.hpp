// The kernels that this machine runs; chosen once, see set_simd() in network.hpp.
#pragma once

#include <trocar/tissue/network/network_layout.hpp>

namespace trocar::tissue {

const KernelSet& kernels() noexcept;

}  // namespace trocar::tissue
