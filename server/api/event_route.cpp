#include <fmt/format.h>
#include <httplib.h>

#include <chrono>
#include <memory>
#include <thread>

#include "api/documents_json.hpp"
#include "api/query.hpp"
#include "api/reply.hpp"
#include "api/routes.hpp"

namespace steerstat {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto between_events = 200ms;    ///< at least
constexpr auto between_looks = 1'000ms;   ///< whether the client is still there, at most
constexpr auto between_signs = 10'000ms;  ///< of life, at most

/// A stream of one study's events, on the worker that serves it.
class EventStream {
 public:
  /// @param seen  revision that the client knows, 0 for none
  EventStream(Surroundings& surroundings, std::string id, std::uint64_t seen, std::shared_ptr<void> place)
      : surroundings_(surroundings), id_(std::move(id)), seen_(seen), place_(std::move(place)) {}

  /// Sends the next event, or nothing after a while without one. @return whether the client is still there
  bool advance(httplib::DataSink& sink) {
    const std::stop_token stop = surroundings_.stop.get_token();
    if (!begun_) {
      begun_ = true;
      if (!send(sink, "retry: 2000\n\n")) return false;
    }
    std::this_thread::sleep_until(next_event_);
    const std::optional<StudyState> state = surroundings_.service.wait_for_change(id_, seen_, between_looks, stop);
    if (!state || stop.stop_requested()) {
      sink.done();
      return true;
    }
    if (state->revision == seen_) return sink.is_writable() && show_life(sink);
    seen_ = state->revision;
    next_event_ = Clock::now() + between_events;
    const bool over = is_over(state->status);
    const bool sent = send(
        sink, fmt::format("id: {}\nevent: {}\ndata: {}\n\n", seen_, over ? "done" : "progress", state_json(*state)));
    if (over) sink.done();
    return sent;
  }

 private:
  bool send(httplib::DataSink& sink, const std::string& text) {
    last_sign_ = Clock::now();
    return sink.write(text.data(), text.size());
  }

  /// A comment now and then keeps proxies from giving up.
  bool show_life(httplib::DataSink& sink) {
    return Clock::now() - last_sign_ < between_signs || send(sink, ": waiting\n\n");
  }

  Surroundings& surroundings_;
  std::string id_;
  std::uint64_t seen_;
  std::shared_ptr<void> place_;
  bool begun_{false};
  Clock::time_point next_event_{};
  Clock::time_point last_sign_{};
};

void stream(Surroundings& surroundings, const Call& call, httplib::Response& response) {
  expect_parameters(call.request, {});
  const std::string& id = id_of(call);
  const StudyState state = state_of(surroundings.service, id);
  const std::uint64_t seen = natural_number(call.request.get_header_value("Last-Event-ID")).value_or(0);
  if (is_over(state.status) && seen == state.revision) {
    response.status = 204;  // nothing will come: browsers stop asking then
    return;
  }
  const auto events =
      std::make_shared<EventStream>(surroundings, id, seen, take_place(surroundings.streams, "streams of events"));
  response.set_header("Cache-Control", "no-store");
  response.set_header("X-Accel-Buffering", "no");  // nginx would else keep events back
  response.set_header("Connection", "close");      // where the stream ends is the connection's end
  response.set_content_provider("text/event-stream",
                                [events](std::size_t, httplib::DataSink& sink) { return events->advance(sink); });
}

}  // namespace

void add_event_route(Router& router, Surroundings& surroundings) {
  router.add("GET", "/v1/studies/{id}/events",
             [&](const Call& call, auto& response) { stream(surroundings, call, response); });
}

}  // namespace steerstat
