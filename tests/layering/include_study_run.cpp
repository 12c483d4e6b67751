#include "study/run.hpp"
