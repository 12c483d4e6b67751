#pragma once

#include <span>
#include <string>

#include "study/reader_json.hpp"
#include "study/study.hpp"

namespace steerstat {

/// Decodes a spec's `sampling.proposal`: {"nominal": share, "components": [{"share", "inputs": {NAME: {"shift",
/// "scale"}}}]}.
///
/// @param inputs    decoded: only those with distributions have a proposal
/// @param mistaken  names of the inputs that have mistakes of their own: what they are is not known
/// @return without components where mistakes were noted
Proposal decode_proposal(const Reader& reader, std::span<const Input> inputs, std::span<const std::string> mistaken);

/// What the method importance draws from where a spec does not say: half of the draws nominal, half from a component
/// that draws every input 1.5 times as wide.
Proposal default_proposal(std::span<const Input> inputs);

/// A proposal as a spec writes it, every default filled in.
nlohmann::json encode_proposal(const Proposal& proposal);

}  // namespace steerstat
