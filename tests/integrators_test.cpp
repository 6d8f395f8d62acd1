// integrators_test.cpp
