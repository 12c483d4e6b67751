#include "control/cycle.hpp"
