// materials_test.cpp
