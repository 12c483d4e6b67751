#pragma once

#include <cstdint>
#include <string>

#include "raw_client.hpp"

namespace steerstat::testing {

/// Who answers at a port: the whole service, or the door before what a test puts there. Of those answers the refusals
/// alone are noted, which are the door's.
enum class Answerer : std::uint8_t { service, door };

/// Has every answer from the port noted, for tests/contract to hold it against schemas/openapi.yaml. Thread-safe.
void record_answers(std::uint16_t port, Answerer answerer);

/// Notes an answer, where its port is one of those: a line of JSON in a file of this process in the directory that the
/// environment's STEERSTAT_ANSWERS names, if it names one. Thread-safe.
///
/// @param request  as it was sent, from its first line on
void note_answer(std::uint16_t port, const std::string& request, const RawResponse& response);

}  // namespace steerstat::testing
