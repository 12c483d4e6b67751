#pragma once

#include <chrono>
#include <cstddef>

namespace steerstat {

/// What a client may cost before and while it is answered.
struct DoorLimits {
  std::size_t head_bytes{16U << 10U};            ///< request line and header fields together; 431 beyond
  std::size_t target_bytes{4U << 10U};           ///< of the request line's target; 414 beyond
  std::size_t field_bytes{4U << 10U};            ///< of a header field; 431 beyond. The library takes up to 8 KiB
  std::size_t fields{64};                        ///< header fields; 431 beyond
  std::size_t body_bytes{1U << 20U};             ///< 413 beyond
  std::chrono::milliseconds head_time{5'000};    ///< from the first byte to the whole head, however it drips; 408 after
  std::chrono::milliseconds body_time{10'000};   ///< from the head to the whole body; 408 after
  std::chrono::milliseconds idle_time{15'000};   ///< that a connection without a request is kept
  std::chrono::milliseconds write_time{10'000};  ///< that writing each 64 KiB of a response may block
  std::chrono::milliseconds linger_time{2'000};  ///< that a refused client may go on sending before the reset
  std::size_t connections{512};                  ///< at once; beyond, the oldest without a whole request goes
  std::size_t workers{96};                       ///< requests answered at once
};

}  // namespace steerstat
