#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace httplib {
struct Request;
struct Response;
}  // namespace httplib

namespace steerstat {

/// A request, and what its path has where the route's pattern has `{name}`s.
struct Call {
  const httplib::Request& request;
  std::vector<std::string> values;  ///< in the pattern's order
};

/// Which handler a method and a path go to. Matches whole segments, one by one.
class Router {
 public:
  using Handler = std::function<void(const Call&, httplib::Response&)>;

  struct Route {
    std::string method;
    std::string pattern;                ///< "/v1/studies/{id}"
    std::vector<std::string> segments;  ///< of the pattern
    Handler handler;
  };
  struct Match {
    const Route* route;
    std::vector<std::string> values;
  };

  void add(const std::string& method, const std::string& pattern, Handler handler);

  /// HEAD goes where GET goes. Thread-safe once all are added.
  /// @throws Refused 404, and 405 with Allow
  [[nodiscard]] Match find(std::string_view method, std::string_view path) const;

  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

}  // namespace steerstat
