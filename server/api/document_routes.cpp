#include <fmt/format.h>
#include <httplib.h>

#include "api/embedded_documents.hpp"
#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"
#include "core/version.hpp"
#include "study/parse_json.hpp"

namespace steerstat {
namespace {

constexpr std::string_view suffix = ".schema.json";

void show_schema(const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& name = call.values.front();
  std::string known;
  for (const EmbeddedDocument& schema : embedded_schemas()) {
    const std::string_view short_name = schema.name.substr(0, schema.name.size() - suffix.size());
    if (name != schema.name && name != short_name) {
      known += (known.empty() ? "" : ", ") + std::string(short_name);
      continue;
    }
    reply_json(response, schema.text);
    return;
  }
  throw Refused({404, fmt::format("there is no schema {} (there are {})", quote(name), known), {}, {}});
}

constexpr const char* plain_page = R"(<!doctype html>
<html lang="en">
<meta charset="utf-8">
<title>steerstat</title>
<h1>steerstat</h1>
<p>The service is running. This program was built without the dashboard; the API is all there:
<a href="openapi.json">openapi.json</a> describes it, and these are its <a href="v1/studies">studies</a>.</p>
</html>
)";

/// Of a page: all of it from here, nothing of it in other sites' frames.
constexpr const char* page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; font-src 'self'; connect-src "
    "'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

void show_asset(const Asset& asset, httplib::Response& response) {
  response.set_header("Content-Security-Policy", page_policy);
  response.set_header("Cache-Control", "no-cache");
  response.set_content(asset.content.data(), asset.content.size(), std::string(asset.type));
}

}  // namespace

void add_document_routes(Router& router, Surroundings& surroundings) {
  router.add("GET", "/v1/schemas/{name}", show_schema);
  router.add("GET", "/openapi.json", [](const Call& call, httplib::Response& response) {
    expect_parameters(call.request, {});
    reply_json(response, embedded_openapi());
  });
  router.add("GET", "/healthz", [](const Call&, httplib::Response& response) {
    reply_json(response, fmt::format("{{\"status\":\"ok\",\"version\":\"{}\"}}\n", engine_version()));
  });
  router.add("GET", "/metrics", [&surroundings](const Call&, httplib::Response& response) {
    std::string text = metrics_text(surroundings.service.counters());
    const auto& door = surroundings.options.door;
    if (door) text += metrics_text(door(), surroundings.streams.taken());
    text += surroundings.metrics.text();
    response.set_header("Cache-Control", "no-store");
    response.set_content(text, "text/plain; version=0.0.4; charset=utf-8");
  });
}

void add_dashboard(Router& router, const Surroundings& surroundings) {
  bool has_front = false;
  for (const Asset& asset : surroundings.options.assets) {
    has_front = has_front || asset.path == "/";
    router.add("GET", std::string(asset.path),
               [asset](const Call&, httplib::Response& response) { show_asset(asset, response); });
  }
  if (has_front) return;
  router.add("GET", "/", [](const Call&, httplib::Response& response) {
    show_asset({"/", "text/html; charset=utf-8", plain_page}, response);
  });
}

}  // namespace steerstat
