# A kernel's `__shared__ type name[n];` becomes `auto& name = emulated_device::shared<type[n]>();`.
s/__shared__ (.*[^ ]) ([a-z_]+)(\[.*\])?;/auto\& \2 = emulated_device::shared<\1\3>();/
