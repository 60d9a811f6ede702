// The program as a child process: what it prints, how it ends.
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace accrete::cli {

struct Ended {
  int status = -1;  // exit status, or 1000 + signal
  std::string out, err;
};

class Child {
 public:
  // `folder`: its working folder, where also what it prints is kept. `prepare` runs in the child before the program.
  Child(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
        const std::function<void()>& prepare = {})
      : out_(folder / "stdout.txt"), err_(folder / "stderr.txt") {
    std::filesystem::remove(out_);
    std::filesystem::remove(err_);
    std::vector<std::string> words = program();
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    pid_ = ::fork();
    if (pid_ != 0) return;
    const int out = ::open(out_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    const int err = ::open(err_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    if (out < 0 || err < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0 || ::chdir(folder.c_str()) != 0) ::_exit(99);
    if (prepare) prepare();
    ::execvp(argv[0], argv.data());
    ::_exit(98);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
  }

  // Waits until it has printed `text` on standard error; false when it ended before, or after ten minutes.
  [[nodiscard]] bool wait_for(const std::string& text) const {
    for (int i = 0; i < 6000; ++i) {  // an emulator needs two minutes
      if (read(err_).find(text) != std::string::npos) return true;
      siginfo_t info{};
      if (::waitid(P_PID, static_cast<id_t>(pid_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == pid_)
        return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    return false;
  }

  void signal(int number) const { ::kill(pid_, number); }

  Ended wait() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), read(out_), read(err_)};
  }

 private:
  // After its emulator, if this test is for another processor: the kernel that runs the child is the host's.
  static std::vector<std::string> program() {
    std::vector<std::string> words;
    std::istringstream emulator(ACCRETE_EMULATOR);
    for (std::string word; std::getline(emulator, word, '|');) words.push_back(word);
    words.emplace_back(ACCRETE_PROGRAM);
    return words;
  }
  static std::string read(const std::filesystem::path& file) {
    std::ostringstream text;
    text << std::ifstream(file, std::ios::binary).rdbuf();
    return text.str();
  }

  std::filesystem::path out_, err_;
  pid_t pid_ = 0;
};

inline Ended run_program(const std::filesystem::path& folder, const std::vector<std::string>& arguments) {
  return Child(folder, arguments).wait();
}

}  // namespace accrete::cli
