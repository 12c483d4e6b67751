#include <fmt/format.h>

#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "api/api.hpp"
#include "commands.hpp"
#include "core/errors.hpp"
#include "hardening/http_server.hpp"
#include "hardening/token.hpp"
#include "interruption.hpp"
#include "output.hpp"
#include "page/embedded_page.hpp"
#include "service/study_service.hpp"

namespace steerstat {
namespace {

constexpr const char* serve_epilogue =
    R"(Keeps studies in a directory, runs them side by side, and answers for them: /openapi.json
describes the API, / is the dashboard. A study is accepted once it is on the disk; unfinished ones go on at the next
start. One process serves a directory at a time.

Prints one line with its address once it is ready. The first interrupt (Ctrl-C, SIGTERM) finishes the trials in flight,
but for those that take longer than half a minute, keeps everything and exits 0; a second one ends at once, and loses no
finished study either.

Others than this machine's users reach it only with --host and a --token-file, a file of its owner's alone:
  (umask 077 && openssl rand -hex 32 > token)
They show the token as `Authorization: Bearer TOKEN`, browsers as the password of any user. It goes over the network as
it is: put a proxy that speaks TLS before it, and name the proxy's host with --allow-host.

Examples:
  steerstat serve
  steerstat serve --port 0 --data /var/lib/steerstat
  steerstat serve --host 0.0.0.0 --token-file token
  curl --json @study.json http://127.0.0.1:8080/v1/studies)";

struct ServeRequest {
  std::string host{"127.0.0.1"};
  std::uint16_t port{8080};
  std::string data{"steerstat-data"};
  unsigned threads{0};
  std::optional<std::string> token_file;
  std::vector<std::string> allowed_hosts;
  std::string launcher;
};

DoorOptions door_options(const ServeRequest& request) {
  DoorOptions options;
  options.host = request.host;
  options.port = request.port;
  options.allowed_hosts = request.allowed_hosts;
  if (request.token_file) options.token = read_token_file(*request.token_file);
  return options;
}

/// Ends what answers before that goes which it stands on.
class Closing {
 public:
  Closing(Api& api, HttpServer& server) : api_(api), server_(server) {}
  ~Closing() {
    api_.stop();
    server_.stop(std::chrono::seconds(5));
  }
  Closing(const Closing&) = delete;
  Closing& operator=(const Closing&) = delete;

 private:
  Api& api_;
  HttpServer& server_;
};

void wait_for(const Interruption& interruption) {
  std::mutex mutex;
  std::unique_lock lock(mutex);
  std::condition_variable_any never;
  never.wait(lock, interruption.token(), [] { return false; });
}

/// The page, in the files that its HTML refers to; none in a program without it.
std::vector<Asset> page_assets() {
  const PageFiles page = embedded_page();
  if (!page.absence.empty()) return {};
  return {{"/", "text/html; charset=utf-8", page.html},
          {"/page.css", "text/css; charset=utf-8", page.style},
          {"/page.js", "text/javascript; charset=utf-8", page.script}};
}

/// The command's words, cut at spaces.
std::optional<Launcher> launcher_of(const ServeRequest& request) {
  if (request.launcher.empty()) return std::nullopt;
  Launcher launcher;
  std::istringstream words(request.launcher);
  for (std::string word; words >> word;) launcher.prefix.push_back(word);
  if (launcher.prefix.empty()) throw BadUsage("--launcher: there is no command in it; name one, such as \"srun -N4\"");
  launcher.program = std::filesystem::read_symlink("/proc/self/exe").string();
  return launcher;
}

ExitCode run(const ServeRequest& request) {
  HttpServer server(door_options(request));  // first: a port in use is told before any study goes on
  const Interruption interruption;
  const auto tell_line = [](const std::string& line) { tell(line); };
  StudyService service(request.data, request.threads, {}, tell_line, launcher_of(request));
  ApiOptions options;
  options.assets = page_assets();
  options.door = [&server] { return server.counters(); };
  Api api(service, std::move(options));
  {
    const Closing closing(api, server);
    server.open([&api](const auto& question, auto& answer) { api.answer(question, answer); }, tell_line);
    print(fmt::format("steerstat serves {}/ (studies in {})\n", server.url(), request.data));
    wait_for(interruption);
    tell("finishing the trials in flight; interrupt again to end at once");
  }
  service.stop();
  return ExitCode::done;
}

}  // namespace

void add_serve(CLI::App& program, ExitCode& exit_code) {
  CLI::App* command = program.add_subcommand("serve", "Serve studies over HTTP, with a dashboard");
  const auto request = std::make_shared<ServeRequest>();
  command->add_option("--host", request->host, "Listen at this address; 127.0.0.1 unless given")->type_name("ADDRESS");
  command->add_option("--port", request->port, "Listen at this port; 8080 unless given, 0 for a free one")
      ->type_name("PORT");
  command->add_option("--data", request->data, "Keep the studies in this directory; ./steerstat-data unless given")
      ->type_name("DIR");
  command->add_option("--threads", request->threads, "Threads to run trials on; one a core unless given")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U).description(""));
  command->add_option("--token-file", request->token_file, "Ask clients for the token in this file")->type_name("FILE");
  command
      ->add_option("--allow-host", request->allowed_hosts,
                   "Answer to this name too, such as a proxy's; may be given several times")
      ->type_name("NAME");
  command
      ->add_option("--launcher", request->launcher,
                   "Run each study as a program of its own, COMMAND steerstat run ..., such as \"srun -N4\"")
      ->type_name("COMMAND");
  command->footer(serve_epilogue);
  command->callback([request, &exit_code] { exit_code = run(*request); });
}

}  // namespace steerstat
