// metrics_test.cpp
