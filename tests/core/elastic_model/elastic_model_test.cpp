#include "core/elastic_model/elastic_model.h"

#include <gtest/gtest.h>
