// sampling_test.cpp
