#include "program.hpp"

int main(int argc, char** argv) {
  return static_cast<int>(steerstat::run_program(argc, argv));
}
