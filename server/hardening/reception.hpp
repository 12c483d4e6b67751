#pragma once

#include <atomic>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "hardening/admission.hpp"
#include "hardening/connection.hpp"
#include "hardening/door_limits.hpp"
#include "hardening/file_descriptor.hpp"
#include "hardening/problem.hpp"

namespace steerstat {

/// Accepts connections and collects whole requests, all in one thread that waits for none of them: a client that drips
/// its request costs a file descriptor and the bytes it has sent, never a thread. Requests that are wrong or not
/// admitted are answered here, and never reach the rest of the program.
class Reception {
 public:
  using OnArrival = std::function<void(Arrival)>;
  using OnRefusal = std::function<void(int status)>;

  /// @param listening   socket that listens, without blocking
  /// @param on_arrival  takes each whole request, from the reception's thread; must not wait
  /// @param on_refusal  hears of each request that was refused here
  /// @throws RunFailure where the system gives no event descriptor
  Reception(FileDescriptor listening, Admission admission, DoorLimits limits, OnArrival on_arrival,
            OnRefusal on_refusal);

  /// Begins to accept. Once.
  void start();

  /// As stop().
  ~Reception();
  Reception(const Reception&) = delete;
  Reception& operator=(const Reception&) = delete;

  /// Takes a connection back once its request is answered. Thread-safe.
  /// @param keep  whether another request may follow; if not, it is closed as soon as the client has read the answer
  void take_back(Connection connection, bool keep);

  /// Tells that a connection that a request came by will not be taken back. Thread-safe.
  void give_up() { --away_; }

  /// Closes the listening socket and every connection that no request has come by. Not thread-safe with itself.
  void stop();

  /// Open connections that wait here. Thread-safe.
  [[nodiscard]] std::size_t waiting() const { return waiting_; }

 private:
  using Connections = std::list<Connection>;

  void receive();
  void run_once();
  void accept_all();
  bool make_room();
  void take_returned();
  bool on_readable(Connection& connection);
  bool advance(Connection& connection);
  bool begin_body(Connection& connection, std::size_t head_size);
  bool refuse(Connection& connection, const Problem& problem);
  bool on_deadline(Connection& connection);
  void linger(Connection& connection);
  void wake() const;

  FileDescriptor listening_;
  Admission admission_;
  DoorLimits limits_;
  OnArrival on_arrival_;
  OnRefusal on_refusal_;
  FileDescriptor wake_;
  Connections connections_;
  std::atomic<std::size_t> waiting_{0};
  std::atomic<std::size_t> away_{0};                ///< connections whose requests are being answered
  Connection::Clock::time_point accepting_from_{};  ///< later than now while descriptors are short
  std::mutex mutex_;
  std::vector<Connection> returned_;  ///< guarded by mutex_
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// A whole response that says a problem and ends the connection.
std::string problem_response(const Problem& problem);

}  // namespace steerstat
