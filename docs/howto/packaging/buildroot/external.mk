include $(sort $(wildcard $(BR2_EXTERNAL_ACCRETE_PATH)/package/*/*.mk))
