#include "coast/noise/allan.hpp"
