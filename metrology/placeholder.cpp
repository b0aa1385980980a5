#include "metrology/line.h"
