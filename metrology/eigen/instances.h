#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

// What most libraries ask of Eigen with matrices of double: products, triangular solutions and the blocks they are made
// of, decompositions; and of the standard library strings and vectors of numbers, which it has compiled for C++17
// alone. A library that names them compiles them again, some 120 KB in each of twenty; declared here, in the
// precompiled header, they are compiled in instances.cpp alone. Without the precompiled header each compiles its own,
// and the programs are the same. The numbers are Eigen 3.4's: another Eigen that has other templates says so here.

#ifndef STIFFSCOPE_INSTANCE
#define STIFFSCOPE_INSTANCE extern template
#endif

namespace Eigen {
namespace internal {

// A matrix that is read column by column, row by row, and the one that is written.
using ByColumns = const_blas_data_mapper<double, Index, ColMajor>;
using ByRows = const_blas_data_mapper<double, Index, RowMajor>;
using Written = blas_data_mapper<double, Index, ColMajor, 0, 1>;
using Block4 = gebp_traits<double, double>;
inline constexpr int block_rows = Block4::mr, block_columns = Block4::nr, packet_rows = Block4::LhsProgress;
using Packet = Block4::LhsPacket4Packing;

STIFFSCOPE_INSTANCE struct gebp_kernel<double, double, Index, Written, block_rows, block_columns, false, false>;
STIFFSCOPE_INSTANCE struct gemm_pack_lhs<double, Index, ByColumns, block_rows, packet_rows, Packet, ColMajor>;
STIFFSCOPE_INSTANCE struct gemm_pack_lhs<double, Index, ByRows, block_rows, packet_rows, Packet, RowMajor>;
STIFFSCOPE_INSTANCE struct gemm_pack_rhs<double, Index, ByColumns, block_columns, ColMajor>;
STIFFSCOPE_INSTANCE struct gemm_pack_rhs<double, Index, ByRows, block_columns, RowMajor>;
STIFFSCOPE_INSTANCE struct gemm_pack_rhs<double, Index, Written, block_columns, ColMajor, false, true>;

STIFFSCOPE_INSTANCE struct general_matrix_vector_product<Index, double, ByRows, RowMajor, false, double, ByColumns,
                                                         false>;
STIFFSCOPE_INSTANCE struct general_matrix_vector_product<Index, double, ByRows, RowMajor, false, double, ByRows, false,
                                                         1>;
STIFFSCOPE_INSTANCE struct general_matrix_vector_product<Index, double, ByColumns, ColMajor, false, double, ByRows,
                                                         false>;
STIFFSCOPE_INSTANCE struct general_matrix_vector_product<Index, double, ByColumns, ColMajor, false, double, ByColumns,
                                                         false>;

STIFFSCOPE_INSTANCE struct triangular_solve_matrix<double, Index, OnTheLeft, Lower, false, ColMajor, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, RowMajor, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct triangular_solve_matrix<double, Index, OnTheLeft, UnitLower, false, ColMajor, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct triangular_solve_matrix<double, Index, OnTheLeft, Upper, false, ColMajor, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct triangular_solve_matrix<double, Index, OnTheRight, Upper, false, RowMajor, ColMajor, 1>;

// Whole products: each factor read by columns or by rows.
STIFFSCOPE_INSTANCE struct general_matrix_matrix_product<Index, double, ColMajor, false, double, ColMajor, false,
                                                         ColMajor, 1>;
STIFFSCOPE_INSTANCE struct general_matrix_matrix_product<Index, double, ColMajor, false, double, RowMajor, false,
                                                         ColMajor, 1>;
STIFFSCOPE_INSTANCE struct general_matrix_matrix_product<Index, double, RowMajor, false, double, ColMajor, false,
                                                         ColMajor, 1>;
STIFFSCOPE_INSTANCE struct general_matrix_matrix_product<Index, double, RowMajor, false, double, RowMajor, false,
                                                         ColMajor, 1>;
STIFFSCOPE_INSTANCE void evaluateProductBlockingSizesHeuristic<double, double, 1, Index>(Index&, Index&, Index&, Index);
STIFFSCOPE_INSTANCE void evaluateProductBlockingSizesHeuristic<double, double, 4, Index>(Index&, Index&, Index&, Index);

// A triangle times a matrix, and the lower triangle of a product.
STIFFSCOPE_INSTANCE struct product_triangular_matrix_matrix<double, Index, Lower, true, ColMajor, false, ColMajor,
                                                            false, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct product_triangular_matrix_matrix<double, Index, Upper, true, RowMajor, false, ColMajor,
                                                            false, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct product_triangular_matrix_matrix<double, Index, UnitLower, true, ColMajor, false, ColMajor,
                                                            false, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct product_triangular_matrix_matrix<double, Index, UnitUpper, true, RowMajor, false, ColMajor,
                                                            false, ColMajor, 1>;
STIFFSCOPE_INSTANCE struct tribb_kernel<double, double, Index, block_rows, block_columns, false, false, 1, Lower>;
STIFFSCOPE_INSTANCE struct general_matrix_matrix_triangular_product<Index, double, ColMajor, false, double, RowMajor,
                                                                    false, ColMajor, 1, Lower>;

}  // namespace internal

STIFFSCOPE_INSTANCE Isometry3d Isometry3d::inverse(TransformTraits) const;
STIFFSCOPE_INSTANCE LLT<Matrix3d>& LLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
STIFFSCOPE_INSTANCE LLT<MatrixXd>& LLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
STIFFSCOPE_INSTANCE LDLT<Matrix3d>& LDLT<Matrix3d>::compute(const EigenBase<Matrix3d>&);
STIFFSCOPE_INSTANCE LDLT<MatrixXd>& LDLT<MatrixXd>::compute(const EigenBase<MatrixXd>&);
STIFFSCOPE_INSTANCE void LDLT<Matrix3d>::_solve_impl_transposed<true>(const Vector3d&, Vector3d&) const;
STIFFSCOPE_INSTANCE void LDLT<MatrixXd>::_solve_impl_transposed<true>(const VectorXd&, VectorXd&) const;
STIFFSCOPE_INSTANCE SelfAdjointEigenSolver<Matrix3d>& SelfAdjointEigenSolver<Matrix3d>::compute(
    const EigenBase<Matrix3d>&, int);
STIFFSCOPE_INSTANCE AngleAxisd& AngleAxisd::operator=(const QuaternionBase<Quaterniond>&);

}  // namespace Eigen

STIFFSCOPE_INSTANCE class std::basic_string<char>;
STIFFSCOPE_INSTANCE class std::vector<std::string>;
STIFFSCOPE_INSTANCE class std::vector<double>;
STIFFSCOPE_INSTANCE class std::vector<int>;
STIFFSCOPE_INSTANCE class std::vector<std::size_t>;
STIFFSCOPE_INSTANCE class std::vector<Eigen::Vector3d>;
STIFFSCOPE_INSTANCE class std::vector<Eigen::VectorXd>;
STIFFSCOPE_INSTANCE class std::vector<Eigen::MatrixXd>;
