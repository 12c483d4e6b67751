#include "hardening/http_server.hpp"

#include <httplib.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <string_view>
#include <thread>

#include "core/errors.hpp"
#include "hardening/admission.hpp"
#include "hardening/listener.hpp"
#include "hardening/problem.hpp"
#include "hardening/reception.hpp"
#include "hardening/response_stream.hpp"

namespace steerstat {
namespace {

/// Header fields that the library must not act upon: it would compress answers in memory, multiply ranges, or have an
/// opinion of its own on the connection.
constexpr std::array<std::string_view, 7> withheld_fields{
    "accept-encoding", "connection", "content-length", "expect", "range", "transfer-encoding", "upgrade"};

/// The head as the library reads it. A Range goes by another name: those who can serve one look for it there.
std::string head_for_library(const RequestHead& head) {
  std::string text = head.method + " " + head.target + " HTTP/1.1\r\n";
  for (const auto& [name, value] : head.fields) {
    if (name == "range") text += "x-single-range: " + value + "\r\n";
    const bool withheld = std::find(withheld_fields.begin(), withheld_fields.end(), name) != withheld_fields.end();
    if (!withheld && name != "x-single-range") text.append(name).append(": ").append(value).append("\r\n");
  }
  return text + "\r\n";
}

std::vector<std::string> names_of_machine(const std::vector<std::string>& further, const std::string& address) {
  std::vector<std::string> names{"localhost", "127.0.0.1", "::1", address};
  std::array<char, 256> name{};
  if (gethostname(name.data(), name.size() - 1) == 0 && name[0] != '\0') names.emplace_back(name.data());
  names.insert(names.end(), further.begin(), further.end());
  for (std::string& each : names) {
    for (char& c : each) {
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
  }
  return names;
}

/// The part of the library that is used: one request in, one response out.
class Exchange : public httplib::Server {
 public:
  explicit Exchange(HttpServer::Handler handler) {
    // It runs before the library would read a body or match a path, and leaves nothing to do.
    set_pre_routing_handler(
        [handler = std::move(handler)](const httplib::Request& request, httplib::Response& response) {
          handler(request, response);
          return HandlerResponse::Handled;
        });
  }

  /// While it is open, contents are streamed.
  void open(socket_t listening) { svr_sock_ = listening; }
  void cut() { svr_sock_ = INVALID_SOCKET; }

  void answer(ResponseStream& stream, std::string body, bool close) {
    bool closed = false;
    process_request(stream, close, closed, [&body](httplib::Request& request) { request.body = std::move(body); });
  }
};

}  // namespace

void answer_with(httplib::Response& response, const Problem& problem) {
  response.status = problem.status;
  response.headers.clear();
  for (const auto& [name, value] : problem.headers) response.set_header(name, value);
  response.set_header("Cache-Control", "no-store");
  response.set_header("X-Content-Type-Options", "nosniff");
  response.set_content(problem_json(problem), problem_type);
}

class HttpServer::Implementation {
 public:
  explicit Implementation(DoorOptions options)
      : options_(std::move(options)),
        exchange_([this](const httplib::Request& request, httplib::Response& response) { handle(request, response); }) {
    const std::string address = resolve(options_.host);
    if (!is_loopback(address) && !options_.token) {
      throw BadUsage(
          "--host " + options_.host +
          ": others than this machine's users could come in (no token is asked for); give a --token-file, or "
          "serve at 127.0.0.1");
    }
    listener_ = listen_at(address, options_.port);
    url_ = listener_.url();
  }

  ~Implementation() { stop(std::chrono::milliseconds(0)); }

  void open(Handler handler, OnBug on_bug) {
    handler_ = std::move(handler);
    on_bug_ = std::move(on_bug);
    const std::string& address = listener_.address;
    Admission admission{names_of_machine(options_.allowed_hosts, address),
                        address == "0.0.0.0" || address == "::", options_.token};
    exchange_.open(listener_.socket.get());
    pool_ = std::make_unique<httplib::ThreadPool>(options_.limits.workers);
    try {
      reception_.emplace(
          std::move(listener_.socket), std::move(admission), options_.limits,
          [this](Arrival arrival) { enqueue(std::move(arrival)); }, [this](int status) { count_refusal(status); });
      reception_->start();
    } catch (...) {
      pool_->shutdown();
      pool_.reset();
      throw;
    }
  }

  void stop(std::chrono::milliseconds grace) {
    if (!pool_) return;
    stopping_ = true;
    reception_->stop();
    const auto end = std::chrono::steady_clock::now() + grace;
    while (in_flight_ > 0 && std::chrono::steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    cut_ = true;
    exchange_.cut();
    pool_->shutdown();
    pool_.reset();
  }

  [[nodiscard]] DoorCounters counters() const {
    DoorCounters counters{answered_, {}, in_flight_, reception_ ? reception_->waiting() : 0};
    for (std::size_t i = 0; i < refused_.size(); ++i) {
      if (refused_[i] > 0) counters.refused.emplace_back(static_cast<int>(i) + 400, refused_[i]);
    }
    return counters;
  }

  [[nodiscard]] std::uint16_t port() const { return listener_.port; }
  [[nodiscard]] const std::string& url() const { return url_; }

 private:
  void enqueue(Arrival arrival) {
    ++in_flight_;
    // std::function copies.
    const auto shared = std::make_shared<Arrival>(std::move(arrival));
    pool_->enqueue([this, shared] {
      answer(*shared);
      --in_flight_;
    });
  }

  void answer(Arrival& arrival) noexcept {
    try {
      Connection& connection = arrival.connection;
      ResponseStream stream(connection.socket.get(), head_for_library(connection.head), options_.limits, cut_);
      const bool keep = connection.head.keeps_alive && !stopping_;
      exchange_.answer(stream, std::move(arrival.body), !keep);
      reception_->take_back(std::move(connection), keep && stream.ended_well());
    } catch (...) {
      report("a bug ended a request; please report it");
      reception_->give_up();  // the connection closes with the arrival
    }
  }

  void handle(const httplib::Request& request, httplib::Response& response) noexcept {
    ++answered_;
    try {
      try {
        handler_(request, response);
      } catch (const Refused& refused) {
        answer_with(response, refused.problem());
      } catch (const std::exception& bug) {
        answer_with_bug(response, bug.what());
      } catch (...) {
        answer_with_bug(response, "of no known kind");
      }
    } catch (...) {
      response.status = 500;
    }
  }

  void answer_with_bug(httplib::Response& response, const std::string& what) {
    report("a bug ended a request (" + what + "); please report it with the request");
    answer_with(response, {500, "a bug ended the request; the service's log tells more"});
  }

  void report(const std::string& text) noexcept {
    try {
      if (on_bug_) on_bug_(text);
    } catch (...) {
    }
  }

  void count_refusal(int status) {
    if (status >= 400 && status < 600) ++refused_[static_cast<std::size_t>(status - 400)];
  }

  DoorOptions options_;
  Listener listener_;  ///< its socket goes to the reception
  Handler handler_;
  OnBug on_bug_;
  std::string url_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> cut_{false};
  std::atomic<std::uint64_t> answered_{0};
  std::atomic<std::size_t> in_flight_{0};
  std::array<std::atomic<std::uint64_t>, 200> refused_{};
  Exchange exchange_;
  std::unique_ptr<httplib::ThreadPool> pool_;
  std::optional<Reception> reception_;
};

HttpServer::HttpServer(DoorOptions options) : implementation_(std::make_unique<Implementation>(std::move(options))) {}

HttpServer::~HttpServer() = default;

void HttpServer::open(Handler handler, OnBug on_bug) {
  implementation_->open(std::move(handler), std::move(on_bug));
}

void HttpServer::stop(std::chrono::milliseconds grace) {
  implementation_->stop(grace);
}

std::uint16_t HttpServer::port() const {
  return implementation_->port();
}

std::string HttpServer::url() const {
  return implementation_->url();
}

DoorCounters HttpServer::counters() const {
  return implementation_->counters();
}

}  // namespace steerstat
