// vpl_test.cpp
