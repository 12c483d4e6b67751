#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "study/study.hpp"

namespace steerstat {

/// Decodes a study spec, filling in every default.
///
/// @param text       the JSON document
/// @param directory  where relative file names in the spec are looked up; empty: a spec that names files is refused
/// @throws BadSpec with every mistake at once
Study decode_study(std::string_view text, const std::filesystem::path& directory);

/// The spec with its defaults filled in, as canonical JSON: sorted keys, no white space, shortest numbers that read
/// back to the same bits, files inlined. decode_study() of it gives the same study.
std::string canonical_spec(const Study& study);

/// What of canonical_spec() says which trials there may be and when one succeeds: all but the name, the controller
/// (its convergence tolerances stay), the seed, the number of trials, how they are drawn and computed, and what is done
/// with them. Success rates of studies that have it in common are of one population, and compare.
std::string canonical_population(const Study& study);

/// SHA-256 of canonical_population(), 64 hexadecimal digits.
std::string population_sha256(const Study& study);

/// SHA-256 of canonical_spec(), 64 hexadecimal digits.
std::string spec_sha256(const Study& study);

/// The study's identity: 16 hexadecimal digits of a hash of its canonical spec and the engine's version.
std::string study_id(const Study& study);

}  // namespace steerstat
