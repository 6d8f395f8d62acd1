// bad_input_test.cpp
