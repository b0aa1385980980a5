#define STIFFSCOPE_INSTANCE template
#include "metrology/eigen/instances.h"
