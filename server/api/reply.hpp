#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace steerstat {

/// The entity tag of a revision, quotes included.
std::string tag_of(std::uint64_t revision);

/// Whether the client has what the tag is of already (If-None-Match); the response is then a 304 with that tag.
bool has_already(const httplib::Request& request, httplib::Response& response, const std::string& tag);

/// Answers with JSON. A client may keep it, but must ask whether it is still true. @param tag  "" for none
void reply_json(httplib::Response& response, std::string_view json, const std::string& tag = "", int status = 200);

/// What every response says of how browsers may use it. Where it has no Content-Security-Policy yet, it gets the one of
/// a document that is only read.
void secure(httplib::Response& response);

}  // namespace steerstat
