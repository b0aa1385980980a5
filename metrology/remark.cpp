#include "metrology/remark.h"

namespace stiffscope {

Remark::Remark() = default;
Remark::Remark(const Remark&) = default;
Remark::Remark(Remark&&) noexcept = default;
Remark& Remark::operator=(const Remark&) = default;
Remark& Remark::operator=(Remark&&) noexcept = default;
Remark::~Remark() = default;

Remark::Remark(std::type_index family_of_id, int remark_id) : family(family_of_id), id(remark_id) {}

void Remark::add(double number) { values.emplace_back(number); }
void Remark::add(std::int64_t count) { values.emplace_back(count); }
void Remark::add(std::string name) { values.emplace_back(std::move(name)); }
void Remark::add(std::vector<double> numbers) { values.emplace_back(std::move(numbers)); }
void Remark::add(std::vector<std::int64_t> counts) { values.emplace_back(std::move(counts)); }
void Remark::add(std::vector<std::string> names) { values.emplace_back(std::move(names)); }
void Remark::add(std::vector<Remark> remarks) { values.emplace_back(std::move(remarks)); }
void Remark::add(const Remark& remark) { values.emplace_back(std::vector<Remark>{remark}); }

}  // namespace stiffscope
